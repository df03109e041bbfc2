"""Thousands of random scenes in processes of their own: one that hangs or crashes is counted and the others go on; what is done is kept."""

import json
import os
import selectors
import subprocess
import sys
import threading
import time
from pathlib import Path

from mooring_ros.core.cache import _sources_hash as sources_hash

from .random_judge import Ending, judge

HANG, CRASH = "hang", "crash"
PATIENCE = 600.0  # s for one scene, its finer runs included: beyond, it hangs
FIRST = 900.0  # s for the first of a process, which may have to compile


def serve():
    """A worker: seeds on standard input, one JSON object for each on standard output."""
    for line in sys.stdin:
        seed, solver = line.split()
        began = time.perf_counter()
        ending = judge(int(seed), solver)
        print(json.dumps({**ending._asdict(), "seconds": round(time.perf_counter() - began, 3)}), flush=True)


class Worker:
    """A process that judges seeds, started anew when it has been lost."""

    def __init__(self, solver):
        self._solver, self._process, self._patience = solver, None, FIRST

    def judge(self, seed):
        if self._process is None:
            pipes = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.PIPE)
            self._process = subprocess.Popen([sys.executable, "-m", "benchmarks.extremes.campaign"], text=True, **pipes)
            self._patience = FIRST
        process = self._process
        process.stdin.write(f"{seed} {self._solver}\n")
        process.stdin.flush()
        with selectors.DefaultSelector() as ready:
            ready.register(process.stdout, selectors.EVENT_READ)
            answered = ready.select(self._patience)
        line = process.stdout.readline() if answered else ""
        if line:
            self._patience = PATIENCE
            return json.loads(line)
        self._process = None
        process.kill()
        words = process.communicate()[1].strip().splitlines()[-1:] if answered else [f"no answer within {self._patience:g} s"]
        lost = Ending("", CRASH if answered else HANG, " ".join(words))
        return {**lost._asdict(), "seconds": self._patience}

    def close(self):
        if self._process is not None:
            self._process.stdin.close()
            self._process.wait()


def run(seeds, folder, solver="auto", processes=None, progress=None):
    """{seed: result} of all seeds; results are kept in `folder`, by the version of the core, and not asked for twice."""
    path = Path(folder) / f"random-{solver}-{sources_hash()}.jsonl"
    path.parent.mkdir(parents=True, exist_ok=True)
    results = {}
    if path.exists():
        for line in path.read_text(encoding="utf-8").splitlines():
            result = json.loads(line)
            results[result["seed"]] = result
    waiting = [seed for seed in reversed(seeds) if seed not in results]
    lock = threading.Lock()

    def work(file):
        worker = Worker(solver)
        while True:
            with lock:
                if not waiting:
                    break
                seed = waiting.pop()
            result = {"seed": seed, **worker.judge(seed)}
            with lock:
                results[seed] = result
                file.write(json.dumps(result) + "\n")
                file.flush()
                if progress is not None:
                    progress(len(seeds) - len(waiting), len(seeds))
        worker.close()

    with open(path, "a", encoding="utf-8") as file:
        threads = [threading.Thread(target=work, args=(file,)) for _ in range(processes or os.cpu_count() or 1)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    return {seed: results[seed] for seed in seeds}


def reason(result):
    """The words of a refusal without its numbers, for counting."""
    words = result["words"]
    for key in ("did not converge", "stretches a line", "faster than", "ran away", "needs more than", "comes to no balance"):
        if key in words:
            return key
    return words

if __name__ == "__main__":
    serve()
