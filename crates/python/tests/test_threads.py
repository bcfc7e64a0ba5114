"""Progress, exceptions in it, Ctrl-C, and several threads."""

import os
import signal
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
import toile

#: A search that takes minutes.
LONG = {"sizes": {"M": 8}, "evaluations": 10_000_000_000}


class Enough(Exception):
    pass


def test_progress_is_told_by_stage_and_never_falls(poncho):
    told = []
    toile.drape(poncho, quality="preview", progress=lambda *what: told.append(what))
    stages = list(dict.fromkeys(stage for stage, _, _ in told))
    assert "sewing" in stages and "draping" in stages
    shares = [share for _, share, _ in told]
    assert shares == sorted(shares) and 0.0 <= shares[0] and shares[-1] <= 1.0
    assert all(isinstance(words, str) for _, _, words in told)


@pytest.mark.parametrize("work", ["drape", "nest"])
def test_what_progress_raises_stops_the_work_within_a_second_and_is_raised(work, shirt, poncho):
    raised = Enough("here"), []

    def stop(stage, share, words):
        if share > 0.05 or work == "nest":
            raised[1].append(time.monotonic())
            raise raised[0]

    with pytest.raises(Enough) as caught:
        if work == "drape":
            toile.drape(poncho, quality="preview", progress=stop)
        else:
            toile.nest(shirt, **LONG, progress=stop)
    assert caught.value is raised[0]
    assert time.monotonic() - raised[1][0] < 1.0 and len(raised[1]) == 1


def test_progress_that_returns_false_cancels(poncho):
    with pytest.raises(toile.Cancelled):
        toile.drape(poncho, quality="preview", progress=lambda stage, share, words: False)


@pytest.mark.parametrize("progress", [None, lambda stage, share, words: None])
def test_ctrl_c_stops_a_search_within_a_second(shirt, progress):
    sent = []

    def press():
        time.sleep(1.0)
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    # A job that a shell starts in the background ignores the signal.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    threading.Thread(target=press).start()
    try:
        with pytest.raises(KeyboardInterrupt):
            toile.nest(shirt, **LONG, progress=progress)
    finally:
        signal.signal(signal.SIGINT, before)
    assert time.monotonic() - sent[0] < 1.0


def test_python_goes_on_while_a_thread_works(poncho):
    count = 0
    with ThreadPoolExecutor(1) as pool:
        work = pool.submit(toile.drape, poncho, quality="preview")
        while not work.done():
            count += 1
            time.sleep(0.001)
    # A thousand times a second with the lock free; a few times in all with it held.
    assert count > 100 and work.result().sound


def test_threads_get_what_one_gets(poncho):
    with ThreadPoolExecutor(4) as pool:
        made = list(pool.map(lambda _: toile.nest(poncho, evaluations=3_000), range(4)))
    assert all(one.to_bytes("json") == made[0].to_bytes("json") for one in made)


def runnable() -> int:
    """Number of this process's threads besides this one that run, or wait for a processor alone."""
    own, count = threading.get_native_id(), 0
    for task in os.listdir("/proc/self/task"):
        try:
            with open(f"/proc/self/task/{task}/stat") as file:
                state = file.read().rpartition(")")[2].split()[0]
        except OSError:
            continue  # The thread has ended meanwhile.
        count += state == "R" and int(task) != own
    return count


@pytest.mark.skipif(not os.path.isdir("/proc/self/task"), reason="needs Linux's states of threads")
def test_four_threads_run_at_once(shirt):
    counts = []
    with ThreadPoolExecutor(4) as pool:
        work = [
            pool.submit(toile.nest, shirt, sizes={"M": 8}, evaluations=5_000_000, seed=seed, threads=1)
            for seed in range(4)
        ]
        while not any(one.done() for one in work):
            time.sleep(0.005)
            counts.append(runnable())
    # With the lock held, one of them would run and three would wait for it. On a machine with other work this holds, too.
    busy = sum(count >= 2 for count in counts)
    assert len(counts) >= 5 and busy > 0.8 * len(counts), counts
