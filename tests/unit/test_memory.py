"""The bounded store: what it keeps, and threads that ask at once."""

import threading
from concurrent.futures import ThreadPoolExecutor

import pytest

from railquake.memory import Bounded


def test_a_value_is_made_once_and_the_least_recently_used_leaves():
    made = []
    store = Bounded(2)

    def value(key):
        return store.get(key, lambda: made.append(key) or key.upper())

    assert [value(key) for key in "abab"] == ["A", "B", "A", "B"]
    value("a")
    value("c")  # "b" was not used for longest
    assert made == ["a", "b", "c"]
    assert "a" in store and "b" not in store and len(store) == 2
    store.forget("a")
    store.forget("never there")
    value("a")
    assert made == ["a", "b", "c", "a"]
    store.clear()
    assert len(store) == 0


def test_none_is_a_value():
    store = Bounded(1)
    assert store.get(1, lambda: None) is None
    assert store.get(1, lambda: "not made") is None


def test_what_was_put_is_not_made():
    store = Bounded(1)
    assert store.put("key", 1) == 1
    assert store.get("key", lambda: 2) == 1
    store.put("key", 3)
    assert store.get("key", lambda: 2) == 3


def test_threads_that_ask_for_one_key_wait_for_the_one_that_makes_it():
    store, made, all_there = Bounded(4), [], threading.Barrier(8)

    def make():
        made.append(threading.get_ident())
        threading.Event().wait(0.05)
        return object()

    def ask(_):
        all_there.wait()
        return store.get("key", make)

    with ThreadPoolExecutor(8) as threads:
        values = list(threads.map(ask, range(8)))
    assert len(made) == 1 and len(set(map(id, values))) == 1
    assert not store._turns


def test_different_keys_are_made_at_the_same_time():
    store, both = Bounded(4), threading.Barrier(2, timeout=10.0)
    with ThreadPoolExecutor(2) as threads:
        assert sorted(threads.map(lambda key: store.get(key, both.wait), "ab")) == [0, 1]


def test_where_making_fails_the_next_one_tries():
    store, made, all_there = Bounded(4), [], threading.Barrier(4)

    def make():
        made.append(1)
        threading.Event().wait(0.02)
        if len(made) < 3:
            raise ValueError("not yet")
        return "done"

    def ask(_):
        all_there.wait()
        try:
            return store.get("key", make)
        except ValueError as error:
            return str(error)

    with ThreadPoolExecutor(4) as threads:
        answers = sorted(threads.map(ask, range(4)))
    assert answers == ["done", "done", "not yet", "not yet"]
    assert len(made) == 3 and not store._turns


def test_making_a_value_may_need_another_one():
    store = Bounded(4)
    assert store.get("a", lambda: store.get("b", lambda: 1) + 1) == 2

    def again():
        return store.get("c", again)

    with pytest.raises(RecursionError):
        again()
    assert not store._turns and "c" not in store
