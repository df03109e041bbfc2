"""What the figures were measured on."""

import importlib.metadata
import os
import platform
from datetime import datetime, timezone

PACKAGES = ("numpy", "numba", "llvmlite", "moordyn")


def describe():
    """Processor, cores, system, versions and date (UTC) as a dictionary of strings."""
    versions = {}
    for name in PACKAGES:
        try:
            versions[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            versions[name] = "not installed"
    return {
        "processor": _processor(),
        "cores": str(os.cpu_count()),
        "system": f"{platform.system()} {platform.release()}",
        "python": platform.python_version(),
        **versions,
        "load": " ".join(f"{x:.2f}" for x in os.getloadavg()),
        "date": datetime.now(timezone.utc).strftime("%Y-%m-%d"),
    }


def _processor():
    """Vendor, model and vector extensions as Linux tells them."""
    facts = {}
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            for line in file:
                key, _, value = line.partition(":")
                facts.setdefault(key.strip(), value.strip())
    except OSError:
        return platform.processor() or platform.machine()
    name = facts.get("model name", platform.machine())
    family = f"family {facts['cpu family']} model {facts['model']}" if "model" in facts else ""
    vectors = "AVX-512" if "avx512f" in facts.get("flags", "") else "AVX2" if "avx2" in facts.get("flags", "") else ""
    return ", ".join(x for x in (name, family, vectors) if x)


def sentence(facts):
    """The description in one line, for under a table."""
    return (
        f"{facts['processor']}, {facts['cores']} cores, Python {facts['python']}, numba {facts['numba']}, "
        f"MoorDyn {facts['moordyn']}, load average {facts['load']} at the start; {facts['date']}."
    )
