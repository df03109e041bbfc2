"""`mooring validate`: two tension histories side by side."""

import argparse
from dataclasses import asdict

from .compare import common_base, compare
from .console import UsageError, complain, print_json, reading, table
from .files import check_output
from .pairing import listed, pair_names


def add_arguments(parser):
    parser.add_argument("result", metavar="RESULT", help="tension history, MCAP or CSV")
    parser.add_argument("reference", metavar="REFERENCE", help="tension history that it is held against, MCAP or CSV")
    parser.add_argument(
        "--map",
        action="append",
        default=[],
        type=_mapping,
        metavar="A=B",
        help="hold A of RESULT against B of REFERENCE (may be given often); a line's name stands for both of its ends; "
        "the other names pair with their equals",
    )
    parser.add_argument("-o", "--output", metavar="REPORT.html", help="write a report with plots: one file, no network")
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output, nothing else")


def run(args):
    if args.output:
        check_output(args.output, args.result, args.reference)
    bases, comparison = validate(args.result, args.reference, args.map)
    if args.output:
        from .validate_report import write

        with reading(args.output):
            write(args.output, bases, comparison)
    if args.json:
        print_json(comparison)
    else:
        print(_text(comparison))
        if args.output:
            print(f"\nReport: {args.output}")
    return 0


def validate(result_path, reference_path, mapping=()):
    """Compare two histories. Returns ({pair's title: Common}, the object that --json prints). Raises UsageError."""
    from .history import load_history

    with reading(result_path):
        result = load_history(result_path)
    with reading(reference_path):
        reference = load_history(reference_path)
    for remark in (*result.remarks, *reference.remarks):
        complain(remark)
    if result.scale and reference.scale and result.scale != reference.scale:
        raise UsageError(f"{result_path} is at {result.scale}, {reference_path} at {reference.scale}: expected two recordings at the same scale")
    bases, pairs = {}, []
    try:
        names = pair_names(result.series, reference.series, mapping)
        for name, other in names:
            base = common_base(result.times, result.series[name], reference.times, reference.series[other])
            bases[name if name == other else f"{name} and {other}"] = base
            pairs.append({"result": name, "reference": other, **asdict(compare(base))})
    except ValueError as error:
        raise UsageError(f"{result_path} and {reference_path}: {error}") from error
    return bases, {
        "result": str(result_path),
        "reference": str(reference_path),
        "time": {"start": float(base.times[0]), "end": float(base.times[-1]), "samples": len(base.times), "method": base.method},
        "pairs": pairs,
        "unpaired": {
            "result": [name for name in result.series if name not in {name for name, _ in names}],
            "reference": [name for name in reference.series if name not in {other for _, other in names}],
        },
    }


# What is shown of a pair, in the table on the terminal and in the report: heading, how.
COLUMNS = (
    ("Δμ (%)", lambda pair: _signed(pair["mean_difference_percent"])),
    ("Δσ (%)", lambda pair: _signed(pair["std_difference_percent"])),
    ("rms (N)", lambda pair: _plain(pair["rms_difference"])),
    ("rms (% of σ)", lambda pair: _plain(pair["rms_percent_of_std"])),
    ("peak (N)", lambda pair: _plain(pair["peak_difference"])),
    ("lag (s)", lambda pair: "–" if pair["lag"] is None else f"{pair['lag']:+.4f}"),
    ("correlation", lambda pair: "–" if pair["correlation"] is None else f"{pair['correlation']:.6f}"),
)


def rows(comparison):
    """Cells of the table, one row a pair: its title, then COLUMNS."""
    return [[title(pair), *(show(pair) for _, show in COLUMNS)] for pair in comparison["pairs"]]


def title(pair):
    """The name of a pair."""
    return pair["result"] if pair["result"] == pair["reference"] else f"{pair['result']} = {pair['reference']}"


def time_base(comparison):
    """In words: the span, the samples, and how both histories came to them."""
    time = comparison["time"]
    return f"{time['start']:.6g} to {time['end']:.6g} s, {time['samples']} samples, {time['method']}."


def _text(comparison):
    text = [
        f"result:    {comparison['result']}",
        f"reference: {comparison['reference']}",
        f"compared over {time_base(comparison)}",
        "",
        table(["pair", *(heading for heading, _ in COLUMNS)], rows(comparison)),
        "",
        "Δμ = 100 (μ_result − μ_reference)/μ_reference, Δσ alike; rms and peak of the difference; lag > 0: the result comes later",
    ]
    for whose, names in comparison["unpaired"].items():
        if names:
            text.append(f"not compared, of the {whose}: {listed(names)}")
    return "\n".join(text)


def _signed(value):
    return "–" if value is None else f"{value:+.4g}"


def _plain(value):
    return "–" if value is None else f"{value:.4g}"


def _mapping(text):
    name, equals, other = text.partition("=")
    if not (name and equals and other):
        raise argparse.ArgumentTypeError(f"{text!r}: expected A=B, a name of RESULT and a name of REFERENCE")
    return name, other
