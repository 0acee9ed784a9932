from __future__ import annotations

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
