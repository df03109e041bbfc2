"""The interpreter while answers must be punctual: no collection of garbage in the middle of one, and no thread that keeps it from going out."""
import gc
import sys

SWITCH_INTERVAL = 0.0005    # s: how long the recorder's thread may keep the interpreter from an answer
_USUAL_SWITCH_INTERVAL = sys.getswitchinterval()


def be_punctual():
    """From here on garbage is collected only by `collect`, and nothing that is there now is garbage; threads hand over soon."""
    gc.collect()
    gc.freeze()
    gc.disable()
    sys.setswitchinterval(SWITCH_INTERVAL)


def collect():
    """Collect garbage, between two answers."""
    gc.collect()


def be_usual():
    """As before `be_punctual`."""
    gc.enable()
    gc.unfreeze()
    sys.setswitchinterval(_USUAL_SWITCH_INTERVAL)
