"""How an interpreter ends itself that works for too long, whatever the kernel does in it."""

from __future__ import annotations

import faulthandler
import math
import os

try:
    import resource
except ImportError:
    COUNTED_BY_SYSTEM = False  # on Windows
else:
    COUNTED_BY_SYSTEM = True


def limit_time(seconds: float) -> None:
    """End this interpreter once it has worked for so long from now on; a further call counts from then on anew.

    The system counts the time on the processors, where it can: all of them may be busy at once. Elsewhere a watchdog of
    Python's counts the clock's: one that needs no turn of the interpreter, which the kernel may never give.
    """
    if not COUNTED_BY_SYSTEM:
        faulthandler.dump_traceback_later(seconds, exit=True)
        return
    used = resource.getrusage(resource.RUSAGE_SELF)
    soft = math.ceil(used.ru_utime + used.ru_stime + seconds * (os.cpu_count() or 1))
    hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
    resource.setrlimit(resource.RLIMIT_CPU, (soft if hard == resource.RLIM_INFINITY else min(soft, hard), hard))


def stop_limit() -> None:
    """Wait for the next request for as long as it takes: a limit by the clock holds no longer."""
    if not COUNTED_BY_SYSTEM:
        faulthandler.cancel_dump_traceback_later()
