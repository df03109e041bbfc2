"""Side-by-side measurements of mooring_ros: against other codes, against bare kernels and against an experiment.

``python -m benchmarks [NAMES] [--quick] [-o DIR] [--docs]`` runs them. A benchmark is one module of this package, listed in
``__main__``, with ``run(quick) -> dict``. The dictionary holds plain numbers, strings, lists and dictionaries (it becomes JSON) and

- ``"tables"``: dictionary of table name -> Markdown; ``--docs`` puts each between its markers in ``docs/measurements.md``,
- ``"failed"``: list of goals that were missed, in words (empty when all were reached).
"""
