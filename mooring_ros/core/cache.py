"""Where compiled kernels are kept.

numba looks only at the file of a cached function, not at the files of what it calls, so a cache in one fixed folder goes stale when
another stage changes. The folder is therefore named after a hash of every kernel source.
"""

import hashlib
import os
from pathlib import Path

import numba


def _sources_hash():
    digest = hashlib.sha256(numba.__version__.encode())
    for source in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(source.name.encode())
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


def use_keyed_cache():
    """Point numba's cache at a folder of this version of the kernels, unless the user has set NUMBA_CACHE_DIR."""
    if "NUMBA_CACHE_DIR" in os.environ:
        root = Path(os.environ["NUMBA_CACHE_DIR"])
    else:
        root = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "mooring_ros"
    numba.config.CACHE_DIR = str(root / _sources_hash())


use_keyed_cache()


def kernel(function):
    """Compile `function` as a kernel: cached on disk, without the interpreter lock, IEEE semantics (no fastmath)."""
    return numba.njit(cache=True, nogil=True, error_model="numpy", _nrt=False)(function)


def formula(function):
    """Compile a small function of few numbers and tuples: as `kernel`, always inlined."""
    return numba.njit(cache=True, nogil=True, error_model="numpy", forceinline=True, _nrt=False)(function)


def stage(function):
    """Compile a part of a kernel: as `formula`, because passing the tuples of arrays costs more than many a part does.

    Not callable from Python: unpacking the tuples there is most of what such a function takes to compile.
    """
    return numba.njit(
        cache=True, nogil=True, error_model="numpy", forceinline=True, _nrt=False, no_cpython_wrapper=True, no_cfunc_wrapper=True
    )(function)


def routine(function):
    """Compile a part of a kernel that is called, not inlined: what is so long that one copy will do."""
    return numba.njit(cache=True, nogil=True, error_model="numpy", _nrt=False, no_cpython_wrapper=True, no_cfunc_wrapper=True)(function)


def paragraph(function):
    """Put the source of a part in place of its one call: the compiler goes over a called function again with each of its callers."""
    return numba.njit(nogil=True, error_model="numpy", inline="always", _nrt=False)(function)
