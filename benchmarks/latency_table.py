"""The benchmark ``node_latency`` as one of this collection: its rows as a table, and which goals were missed."""

from . import node_latency, tables

RATES = (100.0, 200.0, 500.0)


def run(quick=False):
    """Both nodes at all rates; prints the table."""
    rows = node_latency.run(node_latency.SCENE, RATES, 4.0 if quick else 12.0, 2 if quick else 4, lambda words: None)
    body, failed = [], []
    for row in rows:
        cells = []
        for percent, goal in node_latency.TARGETS.items():
            figures = row[f"p{percent}"]
            cells += [f"{figures['echo']:.3f}", f"{figures['mooring']:.3f}", f"{figures['ratio']:.2f}"]
            if figures["ratio"] > goal:
                failed.append(f"{row['rate']:g} Hz: p{percent} is {figures['ratio']:.2f} times the echo node's, goal {goal}")
        lost = row["lost"]["mooring"]
        if lost:
            failed.append(f"{row['rate']:g} Hz: {lost} inputs without an answer")
        body.append([f"{row['rate']:g}", *cells, lost])
    header = ["rate, Hz", "p50 echo, ms", "p50 mooring, ms", "ratio", "p99 echo, ms", "p99 mooring, ms", "ratio", "lost"]
    content = {"node_latency": tables.table(header, body)}
    print(content["node_latency"], flush=True)
    return {"rows": rows, "tables": content, "failed": failed}
