"""Try small changes of the program, one at a time, on a copy of the checkout, and tell which the tests do not notice.

python -m tests.mutation --sample 80 --seed 1
python -m tests.mutation --modules geometry,brep.skin.curvature

An operator, a comparison, a sign or a bound is changed; then the tests run that call the changed function, and before
it counts as survived all that call anything in its file. Tests are loaded once, and each change is put into the
functions of a forked process; one outside functions is written into its file, which is loaded anew. Changes that change
nothing stand, each with its reason, in `equivalents.txt`. Ends with 1 where more than SURVIVORS of the changes survive,
and with 2 where the tests do not pass without any. Needs a system on which processes can be forked.
"""

from __future__ import annotations

import argparse
import os
import random
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import cast

from tests.mutation.coverage import Chosen, Coverage
from tests.mutation.equivalents import Equivalent, read_equivalents
from tests.mutation.mutants import Mutant, mutants_of
from tests.mutation.runs import LOG, copied, preload, run_tests
from tests.mutation.session import PATIENCE, START_UP, Outcome, Session

SURVIVORS = 0.05
MODULES = "geometry,features,terms,solver,brep.skin.curvature"
# Laws of one folder that others' tests hold, beside those that mirror it.
LAWS = {
    "geometry": (
        *("tests/features", "tests/brep/building/test_sheet.py", "tests/delivery/test_joints.py"),
        *("tests/delivery/test_panel_returns.py", "tests/delivery/test_panel_fixings.py"),
    ),
    "features": ("tests/terms", "tests/geometry/test_patch_under.py"),
    "terms": ("tests/fitting/test_limits.py", "tests/fitting/methods", "tests/fitting/test_seams_run_true.py"),
    "solver": ("tests/fitting/methods",),
}


def main(words: Sequence[str] | None = None) -> int:
    options = _options(words)
    began = time.monotonic()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # processes beside each other leave no core for more
    with tempfile.TemporaryDirectory(prefix="mutation-") as folder:
        copy = copied(options.root, Path(folder).resolve() / "copy")
        paths = sorted({path for name in options.modules for path in files_of(copy, name)})
        found = [mutant for path in paths for mutant in mutants_of(path, (copy / path).read_text(encoding="utf-8"))]
        known = read_equivalents(copy)
        stale = [one for one in known if not one.applies(copy)]
        if stale:
            print("No such changes, though listed as changing nothing:", *stale, sep="\n  ")
            return 2
        tried = _drawn(found, known, copy, options)
        suites = options.suites or sorted({suite for name in options.modules for suite in suites_of(copy, name)})
        preload(kernel=any("brep" in suite for suite in suites))
        told = _Told(copy)
        here = [mutant for mutant in tried if not _needs_a_file(mutant)]
        notes = copy / "notes"
        notes.mkdir()
        session = Session(
            root=copy,
            mutants=here,
            paths=paths,
            notes=notes,
            processes=options.processes,
            timeout=options.timeout,
            most=options.most,
            tell=told.tell,
        )
        print(f"{len(tried)} of {len(found)} changes are tried by {', '.join(suites)}", flush=True)
        whole = run_tests(copy, suites, [session], options.longest)
        if whole != "survived":
            print(f"The tests do not pass as they are ({whole}):", (copy / LOG).read_text(encoding="utf-8")[-3000:])
            return 2
        told.read()
        coverage = Coverage.of(notes)
        for mutant in tried:
            if _needs_a_file(mutant):
                told.tell(mutant, _tried_in_its_file(mutant, copy, coverage, options))
        outcomes = told.outcomes
    return _counted(outcomes, time.monotonic() - began)


def _options(words: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__.partition("\n")[0])
    parser.add_argument("--modules", type=lambda text: text.split(","), default=MODULES.split(","), help=MODULES)
    parser.add_argument("--suites", type=lambda text: text.split(","), help="Test files or folders, in place of all.")
    parser.add_argument("--sample", type=int, default=0, help="So many changes, drawn at random; 0 for all.")
    parser.add_argument("--seed", type=int, default=1, help="Of the random numbers.")
    parser.add_argument("--timeout", type=float, default=0.0, help="Seconds for one change; 0 for what its tests took.")
    parser.add_argument("--most", type=float, default=0.0, help="Seconds of tests for one change; 0 for all of them.")
    parser.add_argument("--processes", type=int, default=len(os.sched_getaffinity(0)), help="At a time.")
    parser.add_argument("--longest", type=float, default=3600.0, help="Seconds for all tests, without a change.")
    parser.add_argument("--root", type=Path, default=Path(__file__).resolve().parents[2], help="Of the checkout.")
    return parser.parse_args(words)


def files_of(root: Path, name: str) -> list[str]:
    """The files of a module or of a folder with all below it, from the root."""
    place = root.joinpath("cadpanel", *name.split("."))
    files = [place.with_suffix(".py")] if place.with_suffix(".py").is_file() else sorted(place.rglob("*.py"))
    if not files:
        raise SystemExit(f"There is no module cadpanel.{name}.")
    return [file.relative_to(root).as_posix() for file in files]


def suites_of(root: Path, name: str) -> list[str]:
    """The tests that mirror a module or folder, and the laws that others hold for it."""
    parts = name.split(".")
    place = root.joinpath("tests", *parts[:-1], f"test_{parts[-1]}.py")
    own = place if place.is_file() else root.joinpath("tests", *parts)
    while not own.exists():
        own = own.parent
    laws = [law for key, values in LAWS.items() if parts[0] == key for law in values if (root / law).exists()]
    return [own.relative_to(root).as_posix(), *laws]


def _drawn(
    found: Sequence[Mutant], known: Sequence[Equivalent], copy: Path, options: argparse.Namespace
) -> Sequence[Mutant]:
    same = {(one.path, one.before, one.after) for one in known}
    left = [one for one in found if (one.path, *one.lines((copy / one.path).read_text(encoding="utf-8"))) not in same]
    return random.Random(options.seed).sample(left, options.sample) if 0 < options.sample < len(left) else left


def _needs_a_file(mutant: Mutant) -> bool:
    """Whether a change counts only where its file is loaded: outside functions, and what other interpreters run."""
    return mutant.function == (0, 0) or mutant.path.startswith("cadpanel/brep/")


def _tried_in_its_file(mutant: Mutant, copy: Path, coverage: Coverage, options: argparse.Namespace) -> Outcome:
    """Change the file, and run the tests that it may fail."""
    file = copy / mutant.path
    text = file.read_text(encoding="utf-8")
    tests = coverage.tests_for(mutant, options.most)
    if not tests:
        return "survived"
    took = {test: coverage.seconds[test] for test in tests}
    file.write_text(mutant.applied(text), encoding="utf-8")
    try:
        seconds = options.timeout or PATIENCE * sum(took.values()) + START_UP
        return run_tests(copy, coverage.files_of(tests), [Chosen(took)], seconds)
    finally:
        file.write_text(text, encoding="utf-8")


class _Told:
    """Outcomes, told as they come by whichever process."""

    def __init__(self, copy: Path) -> None:
        self.outcomes: Counter[Outcome] = Counter()
        self._copy = copy
        self._screen = os.fdopen(os.dup(1), "w", encoding="utf-8")
        self._notes = copy / "outcomes.txt"

    def tell(self, mutant: Mutant, outcome: Outcome) -> None:
        self.outcomes[outcome] += 1
        self._notes.write_text("\n".join(self.outcomes.elements()), encoding="utf-8")
        if outcome != "killed":
            before, after = mutant.lines((self._copy / mutant.path).read_text(encoding="utf-8"))
            print(f"{outcome}: {mutant.path}:{mutant.line}\n    {before}\n    {after}", file=self._screen, flush=True)

    def read(self) -> None:
        """Take over what another process noted."""
        if self._notes.exists():
            self.outcomes = Counter(cast(list[Outcome], self._notes.read_text(encoding="utf-8").split()))


def _counted(outcomes: Counter[Outcome], seconds: float) -> int:
    tried, survived = outcomes.total(), outcomes["survived"]
    share = survived / max(tried, 1)
    print(
        f"{tried} changes in {seconds:.0f} s: {outcomes['killed']} killed, {outcomes['timeout']} ran too long, "
        f"{survived} survived ({share:.1%}, at most {SURVIVORS:.0%})"
    )
    return int(share > SURVIVORS)


if __name__ == "__main__":
    sys.exit(main())
