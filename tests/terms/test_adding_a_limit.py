"""A new limit is one file, a line in the catalogue and, where the user sets it, a field: all else follows from these.

The package is copied, the limit is added to the copy as someone would add it, and the program is run.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import cadpanel
from cadpanel.terms.limits.flange_width import FlangeWidth
from fixtures.make_fixtures import Fixture, write
from tests.delivered import LIP, fitted
from tests.thorough import thorough

PACKAGE = Path(cadpanel.__file__).parent

LIMIT = '''"""Flange width that a shop asks for: its press brake needs something to hold."""

from cadpanel.terms.limits.flange_width import FlangeWidth, WidthTerm
from cadpanel.terms.limits.limit import Row


class HoldingWidth(FlangeWidth):
    """The least width of a flange that the press brake can hold, mm."""

    name = "holding_width"
    what = "holding width"
    default = 20.0
    least = 0.5
    help = "Narrowest flange that the press brake can hold."
    asked = True
    remedy = "narrower flanges"
    rows = (Row("least_holding_width", "Narrowest to hold, mm", "{:.2f}"),)

    def missed(self, panel, value, allowed, length):
        return f"the press brake cannot hold panel '{panel}', which has {value:.0f} mm of {allowed:g}"
'''

RUN = """
import sys
from dataclasses import replace
import cadpanel
from cadpanel.cli.main import main
from cadpanel.fitting.measures.verdict import keeps_limits
from cadpanel.fitting.settings import FitSettings

assert cadpanel.__file__.startswith(sys.argv[1]), cadpanel.__file__
assert FitSettings().allowed["holding_width"] == 20.0
ask = ["fit", "lip.step", "--out"]
codes = [
    main(["fit", "--help"]),
    main([*ask, "none", "--holding-width", "0.1"]),
    main([*ask, "usual", "--holding-width", sys.argv[2]]),
    main(["verify", "usual"]),
]
result = cadpanel.fit(cadpanel.read("lip.step"), method="local")
stricter = replace(result.settings, holding_width=600.0, gap_tolerance=100.0)
print(keeps_limits(result.measures, replace(stricter, holding_width=20.0)), keeps_limits(result.measures, stricter))
print(replace(result, settings=stricter).shortfall())
print(codes)
"""


def put(path: Path, before: str, line: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert text.count(before) == 1
    path.write_text(text.replace(before, line + before), encoding="utf-8")


@thorough
def test_a_limit_goes_from_its_file_to_settings_fit_verdict_report_table_and_options(tmp_path: Path) -> None:
    shutil.copytree(PACKAGE, tmp_path / "cadpanel", ignore=shutil.ignore_patterns("__pycache__"))
    limits = tmp_path / "cadpanel" / "terms" / "limits"
    (limits / "holding_width.py").write_text(LIMIT, encoding="utf-8")
    imported = "from cadpanel.terms.limits.holding_width import HoldingWidth\n"
    put(limits / "catalogue.py", "from cadpanel.terms.limits.limit import Limit\n", imported)
    put(limits / "catalogue.py", "    FlangeWidth(),\n", "    HoldingWidth(),\n")
    settings = tmp_path / "cadpanel" / "fitting" / "settings.py"
    put(settings, "from cadpanel.terms.limits.limit import limit_setting\n", imported)
    put(settings, "    blend: tuple[", "    holding_width: float = limit_setting(HoldingWidth)\n")
    write(Fixture(file="lip.step", prefix="N", table=(), lip=LIP), tmp_path / "lip.step")
    asked = 480.0
    answer = subprocess.run(
        [sys.executable, "-c", "import sys; sys.path.insert(0, sys.argv[1]);" + RUN, str(tmp_path), str(asked)],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=240,
    )
    assert answer.returncode == 0, answer.stderr
    *printed, verdicts, missed, codes = answer.stdout.splitlines()
    assert (verdicts, codes) == ("True False", "[0, 2, 0, 0]")
    said = r"the press brake cannot hold panel 'N-03', which has \d+ mm of 600; allow a larger gap or narrower flanges"
    assert re.match(said, missed)
    assert all(word in " ".join(printed) for word in ("--holding-width", "Narrowest flange that", "[default: 20.0]"))
    assert "Narrowest to hold, mm" in " ".join(printed)
    complaints = [line for line in answer.stderr.splitlines() if ": step " not in line and ": at work " not in line]
    assert complaints == ["The holding width must be at least 0.5 mm, not 0.1 mm."]
    report = json.loads((tmp_path / "usual" / "report.json").read_text("utf-8"))
    assert report["settings"]["holding_width"] == asked
    assert report["summary"]["tolerance_met"]
    # Where nobody asks, a flange is narrower.
    assert FlangeWidth().measure(fitted().measures).min() < asked <= report["summary"]["least_holding_width"]
