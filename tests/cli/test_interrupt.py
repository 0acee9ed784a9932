"""The first Ctrl-C ends what can end early, the second the program."""

import signal
import threading

import pytest

from cadpanel.cli.interrupt import first_interrupt_ends, interrupts_stop_once


@pytest.fixture(autouse=True)
def as_in_a_terminal():
    """What is started in the background by a shell ignores interrupts, and leaves it so to whom it starts."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_once_somebody_listens_the_first_interrupt_is_heard_and_the_second_stops():
    with first_interrupt_ends() as interrupt:
        assert not interrupt.heard()
        signal.raise_signal(signal.SIGINT)
        assert interrupt.heard()
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)  # nothing disturbs it while it clears up
    signal.raise_signal(signal.SIGINT)


def test_a_program_is_stopped_once_and_one_that_was_not_leaves_interrupts_as_they_were():
    with interrupts_stop_once(), first_interrupt_ends() as interrupt:
        assert not interrupt.heard()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    with interrupts_stop_once():
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
    signal.raise_signal(signal.SIGINT)


def test_before_anybody_listens_an_interrupt_stops_at_once():
    with first_interrupt_ends(), pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)


def test_who_takes_interrupts_otherwise_goes_on_doing_so():
    heard = []
    before = signal.signal(signal.SIGINT, lambda *_: heard.append(1))
    try:
        with first_interrupt_ends() as interrupt:
            interrupt.heard()
            signal.raise_signal(signal.SIGINT)
        assert (heard, interrupt.heard()) == ([1], False)
    finally:
        signal.signal(signal.SIGINT, before)


def test_beside_the_main_thread_nothing_is_changed():
    def run():
        with first_interrupt_ends() as interrupt:
            heard.append(interrupt.heard())

    heard: list[bool] = []
    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    assert heard == [False]
