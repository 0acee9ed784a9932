"""The first thing that a second interpreter does: it loads its work, and ends if nobody waits for it any more."""

from __future__ import annotations

import gc
import signal
import sys
from importlib import import_module

from cadpanel.brep.isolation.parent_watch import ends_with_whoever_asked


def begin(module: str) -> None:
    """Load a module and run its function `main`.

    Loading the kernel takes seconds in which Python has no turn, and the first request may come meanwhile. So it is
    the standard output that is watched: nothing is said there until all is loaded.

    A terminal tells all processes of Ctrl-C, this one and its copies, too. Whoever asked decides what it means: that
    nothing is read any more, and then this one is ended; or only that a fit is to end with the best so far.

    Args:
        module: its name; it must say nothing while it is loaded.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with ends_with_whoever_asked(sys.stdout.fileno()):
        # The kernel's binding makes a hundred thousand objects that stay: looking for garbage among them again and
        # again while they are made takes a quarter of the start, and later a part of every piece of work.
        gc.disable()
        main = import_module(module).main
        gc.freeze()
        gc.enable()
    main()
