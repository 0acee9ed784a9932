"""Parts that several threads do are counted together, and never more than there are."""

from concurrent.futures import ThreadPoolExecutor

from cadpanel.delivery.parts_done import PartsDone


def test_what_several_threads_do_is_counted_together_and_told_in_order() -> None:
    told: list[tuple[str, int, int]] = []
    done = PartsDone(lambda *step: told.append(step), "verify", 200)
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(done, [1] * 200))
    assert told == [("verify", count, 200) for count in range(1, 201)]


def test_more_than_there_are_is_not_told() -> None:
    told: list[tuple[str, int, int]] = []
    done = PartsDone(lambda *step: told.append(step), "verify", 5)
    done(3)
    done(4)
    assert told == [("verify", 3, 5), ("verify", 5, 5)]
