from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from cadpanel.jobs.engine.serial import Serial
from cadpanel.jobs.work import REFUSED
from tests.jobs.jobs import job, parts


def test_tasks_come_back_in_their_order_with_what_refuses_each(strip: Path) -> None:
    asked = parts(job(strip, 'A = {only = ["none"]}\nB = {only = ["nobody"]}'))
    told: list[str] = []
    found = list(Serial().run([task for _, task in asked], lambda name, *_: told.append(name)))
    assert [one.code for one in found] == [REFUSED, REFUSED]
    assert "no panel 'none'" in str(found[0].said)
    assert "no panel 'nobody'" in str(found[1].said)
    assert [one.key for one in found] == [task.key for _, task in asked]
    assert list(dict.fromkeys(told)) == ["A", "B"]


def test_a_file_that_has_changed_since_is_told_and_ends_nothing(strip: Path) -> None:
    ((_, task),) = parts(job(strip, "A = {}"))
    other = replace(task, contents=(replace(task.contents[0], sha256="0" * 64),))
    (found,) = Serial().run([other], lambda *_: None)
    assert (found.code, found.archive) == (REFUSED, None)
    assert "has changed since the run began" in str(found.said)
