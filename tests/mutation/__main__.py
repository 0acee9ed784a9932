"""Try small changes of the program, one at a time, on a copy of the checkout, and tell which the tests do not notice.

python -m tests.mutation --sample 80 --seed 1
python -m tests.mutation --modules geometry,brep.skin.curvature

An operator, a comparison, a sign or a bound is changed; then those tests run that call the changed function (all that
call anything in its file before a change counts as survived). Changes that change nothing stand, each with its reason,
in `equivalents.txt`. Ends with 1 where more than SURVIVORS of the changes survive, and with 2 where the tests do not
pass without any. Needs a system on which processes can be forked.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from tests.mutation.coverage import Chosen, Coverage, Recorder
from tests.mutation.equivalents import Equivalent, read_equivalents
from tests.mutation.mutants import Mutant, mutants_of
from tests.mutation.runs import LOG, Outcome, copied, preload, run_tests

SURVIVORS = 0.05
MODULES = "geometry,features,terms,solver,brep.skin.curvature"
# Laws of one folder that others' tests hold, beside those that mirror it.
LAWS = {
    "geometry": (
        *("tests/features", "tests/brep/building/test_sheet.py", "tests/delivery/test_joints.py"),
        *("tests/delivery/test_panel_returns.py", "tests/delivery/test_panel_fixings.py"),
    ),
    "features": ("tests/terms",),
    "terms": ("tests/fitting/test_limits.py", "tests/fitting/methods", "tests/fitting/test_seams_run_true.py"),
    "solver": ("tests/fitting/methods",),
}
# A run of tests may take so many times as long as they took without a change, and this many seconds more.
PATIENCE, START_UP = 4.0, 60.0


def main(words: Sequence[str] | None = None) -> int:
    options = _options(words)
    began = time.monotonic()
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
        suites = sorted({suite for name in options.modules for suite in suites_of(copy, name)})
        preload(kernel=any("brep" in suite for suite in suites))
        notes = copy / "coverage.json"
        whole = run_tests(copy, suites, [Recorder(copy, paths, notes)], options.longest)
        if whole != "survived":
            print(f"The tests do not pass as they are ({whole}):", (copy / LOG).read_text(encoding="utf-8")[-3000:])
            return 2
        coverage = Coverage.read(notes)
        print(
            f"{len(coverage.calls)} tests of {', '.join(suites)} pass; {len(tried)} of {len(found)} changes are tried"
        )
        outcomes: Counter[Outcome] = Counter()
        for mutant in tried:
            outcome = _try(mutant, copy, coverage, options.timeout)
            outcomes[outcome] += 1
            if outcome != "killed":
                before, after = mutant.lines((copy / mutant.path).read_text(encoding="utf-8"))
                print(f"{outcome}: {mutant.path}:{mutant.line}\n    {before}\n    {after}", flush=True)
    return _told(outcomes, time.monotonic() - began)


def _options(words: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__.partition("\n")[0])
    parser.add_argument("--modules", type=lambda text: text.split(","), default=MODULES.split(","), help=MODULES)
    parser.add_argument("--sample", type=int, default=0, help="So many changes, drawn at random; 0 for all.")
    parser.add_argument("--seed", type=int, default=1, help="Of the random numbers.")
    parser.add_argument("--timeout", type=float, default=0.0, help="Seconds for one change; 0 for what its tests took.")
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


def _try(mutant: Mutant, copy: Path, coverage: Coverage, timeout: float) -> Outcome:
    """Run the tests that call the changed function; and before it counts as survived, all that call its file."""
    file = copy / mutant.path
    text = file.read_text(encoding="utf-8")
    file.write_text(mutant.applied(text), encoding="utf-8")
    try:
        done: set[str] = set()
        for function in (mutant.function, (0, 0)):
            tests = coverage.tests_of(mutant.path, function)
            if function == (0, 0):
                tests |= coverage.beside(tests)
            tests -= done
            done |= tests
            if tests:
                took = {test: coverage.seconds[test] for test in tests}
                seconds = timeout or PATIENCE * sum(took.values()) + START_UP
                outcome = run_tests(copy, coverage.files_of(tests), [Chosen(took)], seconds)
                if outcome != "survived":
                    return outcome
        return "survived"
    finally:
        file.write_text(text, encoding="utf-8")


def _told(outcomes: Counter[Outcome], seconds: float) -> int:
    tried, survived = outcomes.total(), outcomes["survived"]
    share = survived / max(tried, 1)
    print(
        f"{tried} changes in {seconds:.0f} s: {outcomes['killed']} killed, {outcomes['timeout']} ran too long, "
        f"{survived} survived ({share:.1%}, at most {SURVIVORS:.0%})"
    )
    return int(share > SURVIVORS)


if __name__ == "__main__":
    sys.exit(main())
