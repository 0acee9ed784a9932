"""Attack the program: with damaged files, with deliveries that were tampered with, with kills.

    python -m tests.attack fuzz --count 2000 --seed 1
    python -m tests.attack tamper
    python -m tests.attack kill --count 200 --seed 1

The same counts and seeds try the same. Ends with 1 where something has come through: a traceback, a process that died,
what is no sentence, a tampering that is neither noticed nor listed as not proved, a delivery that is not whole. Needs a
system on which processes can be forked.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from pathlib import Path

from cadpanel.brep.kernel.messages import silence_kernel
from tests.attack.fuzz import KINDS, Fuzzer
from tests.attack.kill import GONE_WITHIN, Killer
from tests.attack.tamper import Tamperer
from tests.attack.workers import Ended, tried

TELL = 100
"""Inputs after which it is said how many are done."""


def main(words: Sequence[str] | None = None) -> int:
    """See the module's text."""
    options = _options(words)
    began = time.monotonic()
    silence_kernel()  # which tells of every file that it writes
    with tempfile.TemporaryDirectory(prefix="attack-") as name:
        came_through = {"fuzz": fuzz, "tamper": tamper, "kill": kill}[options.attack](Path(name), options)
    print(f"{came_through} came through; {time.monotonic() - began:.0f} s")
    return 1 if came_through else 0


def fuzz(made: Path, options: argparse.Namespace) -> int:
    """Damaged files of every kind, as many of each."""
    fuzzer = Fuzzer(made)
    inputs = [(KINDS[place % len(KINDS)], options.seed + place // len(KINDS)) for place in range(options.count)]
    inputs = [one for one in inputs if options.only in one[0]]
    return _told(tried(inputs, fuzzer.attempt, fuzzer.prepare, options.processes), by_kind=True)


def tamper(made: Path, options: argparse.Namespace) -> int:
    """Every kind of tampering, or as many of them as are asked for, evenly chosen."""
    tamperer = Tamperer(made)
    names = [name for name in tamperer.kinds if options.only in name]
    step = max(1, len(names) // options.count)
    inputs = [(name, 0) for name in names[options.seed % step :: step]]
    return _told(tried(inputs, tamperer.attempt, tamperer.prepare, options.processes), by_kind=False)


def kill(made: Path, options: argparse.Namespace) -> int:
    """Kills, every fourth of them of a whole delivery with its second interpreter."""
    killer = Killer(made)
    found = [killer.kill(options.seed + place, whole=place % 4 == 0) for place in range(options.count)]
    faults = [one for one in found if one.end != "whole" or one.gone > GONE_WITHIN or one.left]
    for one in faults:
        print(one)
    whole = sum(one.end == "whole" for one in found)
    print(
        f"target whole and present in {whole} of {len(found)} kills; whatever they had started was gone after "
        f"{max(one.gone for one in found):.2f} s at most; {sum(one.litter > 0 for one in found)} left folders, the "
        f"next run left {sum(bool(one.left) for one in found)}"
    )
    return len(faults)


def _told(tries: Iterable[Ended], *, by_kind: bool) -> int:
    """Say what became of inputs, and from time to time how many are done; how many have come through."""
    found, bad = [], 0
    for one in tries:
        found.append(one)
        if len(found) % TELL == 0:
            print(f"{len(found)} tried so far", file=sys.stderr, flush=True)
        if one.end.split(":")[0].isupper():
            bad += 1
            print(f"{one.kind}, seed {one.seed}: {one.end}", flush=True)
    ends: dict[str, Counter[str]] = defaultdict(Counter)
    for one in found:
        ends[one.kind if by_kind else "all kinds"][one.end.split(":")[0]] += 1
    for kind, count in ends.items():
        print(f"{kind}: {', '.join(f'{number} {end}' for end, number in count.most_common())}")
    print(f"{len(found)} tried")
    return bad


def _options(words: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.attack", description="Attack the program.")
    parser.add_argument("attack", choices=("fuzz", "tamper", "kill"))
    parser.add_argument("--count", type=int, default=2000, help="how many inputs, kinds or kills")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="only kinds with this in their names")
    parser.add_argument("--processes", type=int, default=os.cpu_count() or 1)
    return parser.parse_args(words)


if __name__ == "__main__":
    sys.exit(main())
