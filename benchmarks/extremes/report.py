"""The extremes as a benchmark: the battery beside MoorDyn, and ten thousand random scenes; tables for docs/extremes.md."""

from collections import Counter, defaultdict
from concurrent.futures import ThreadPoolExecutor
from functools import partial

from .. import tables
from . import campaign, judge, moordyn
from .battery import cases

SCENES, FEW = 10_000, 200
FOLDER = "out/extremes"
BAD = (judge.WRONG, judge.NOT_A_NUMBER, campaign.HANG, campaign.CRASH)
ORDER = (judge.RIGHT, "chaotic", judge.REFUSED, *BAD)
SOLVERS = ("explicit", "implicit")
OFTEN = 0.02  # of the samples: a run in which tensions jump in the finest steps more often than this tells its user
OUTCOMES = {
    judge.RIGHT: "right",
    judge.REFUSED: "refused, as it should be",
    judge.WRONG: "**wrong**",
    judge.NOT_A_NUMBER: "**NaN**",
    moordyn.STOPPED: "stopped",
    moordyn.CRASH: "**crash**",
    moordyn.HANG: "no end in 60 s",
    moordyn.APART: "—",
}


def battery():
    """Rows of the battery: dicts of the case's name and item, and the verdicts by code and setting."""
    rows = []
    for case in cases():
        verdicts = {solver: judge.judge(case, solver) for solver in SOLVERS}
        with ThreadPoolExecutor(len(moordyn.SETTINGS)) as both:
            verdicts |= dict(zip((f"MoorDyn {setting}" for setting in moordyn.SETTINGS), both.map(partial(moordyn.verdict, case), moordyn.SETTINGS)))
        rows.append({"name": case.name, "item": case.item, "verdicts": {who: (verdict.outcome, verdict.words) for who, verdict in verdicts.items()}})
        print(f"{case.name:28s}", *(f"{who}: {outcome};" for who, (outcome, _) in rows[-1]["verdicts"].items()), flush=True)
    return rows


def battery_table(rows):
    columns = list(rows[0]["verdicts"])
    body = [[row["item"], row["name"], *(OUTCOMES[row["verdicts"][who][0]] for who in columns)] for row in rows]
    return tables.table(["extreme", "case", *columns], body)


def random_table(results):
    """Counts by layout."""
    counts = defaultdict(Counter)
    for result in results.values():
        counts[result["layout"] or "lost"][result["outcome"]] += 1
        counts["all"][result["outcome"]] += 1
    names = sorted(counts.keys() - {"all"}) + ["all"]
    return tables.table(["layout", *ORDER], [[name.replace("_", " "), *(counts[name][outcome] for outcome in ORDER)] for name in names])


def told_table(results):
    """How many runs of each outcome say that tensions jump in their finest steps."""
    told = defaultdict(Counter)
    for result in results.values():
        told[result["outcome"]][result["uneven"] > OFTEN] += 1
    body = [[outcome, sum(told[outcome].values()), told[outcome][True]] for outcome in (judge.RIGHT, "chaotic", judge.WRONG)]
    return tables.table(["outcome", "scenes", f"uneven in more than {100 * OFTEN:g} % of the samples"], body)


def reasons_table(results):
    reasons = Counter(campaign.reason(result) for result in results.values() if result["outcome"] == judge.REFUSED)
    return tables.table(["refused because", "scenes"], [[f"... {words} ...", count] for words, count in reasons.most_common()])


def run(quick=False):
    """Both; everything that is wrong, no number, hung or crashed is a goal missed."""
    rows = battery()
    results = campaign.run(range(FEW if quick else SCENES), FOLDER)
    content = {"extremes_battery": battery_table(rows), "extremes_random": random_table(results)}
    content |= {"extremes_told": told_table(results), "extremes_refused": reasons_table(results)}
    for table in content.values():
        print(table, flush=True)
    failed = [f"{row['name']}, {solver}: {row['verdicts'][solver][1]}" for row in rows for solver in SOLVERS if row["verdicts"][solver][0] in BAD]
    failed += [f"random scene {seed}: {result['outcome']}: {result['words']}" for seed, result in results.items() if result["outcome"] in BAD]
    return {"rows": rows, "tables": content, "failed": failed, "random": list(results.values())}
