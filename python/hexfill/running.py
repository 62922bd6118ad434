"""What every long verb takes besides its own options: threads, time limit, seed, progress."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from datetime import timedelta
from typing import TYPE_CHECKING, Any

from . import arrays

if TYPE_CHECKING:
    from ._given import Run

#: ``True``, ``False`` or ``None``, or a function of the latest news.
Progress = Callable[[dict[str, Any]], object] | bool | None
#: Seconds.
Time = float | timedelta | None
MOST_THREADS = 1024


def run(
    threads: int | None = None, time_limit: Time = None, seed: int = 0, progress: Progress = None
) -> Run:
    """The arguments, checked, as the compiled half takes them."""
    if progress is not None and not isinstance(progress, bool) and not callable(progress):
        raise TypeError(f"progress must be a function, True or None, not {type(progress).__name__}")
    return {
        "threads": None if threads is None else arrays.whole(threads, "threads", 1, MOST_THREADS),
        "time_limit": None if time_limit is None else arrays.real(time_limit, "time_limit", zero=True),
        "seed": arrays.whole(seed, "seed", 0, 2**64 - 1),
        "progress": teller() if progress is True else progress or None,
    }


def teller() -> Callable[[dict[str, Any]], None]:
    """Shows progress with tqdm if it is installed, else as a line on stderr every few seconds."""
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _Lines()
    return _Bar(tqdm)


class _Lines:
    """A line every few seconds."""

    EVERY = 3.0

    def __init__(self) -> None:
        self.next = time.monotonic() + self.EVERY

    def __call__(self, news: dict[str, Any]) -> None:
        if time.monotonic() < self.next:
            return
        self.next = time.monotonic() + self.EVERY
        of = f" of {news['total']}" if news["total"] is not None else ""
        words = f": {news['message']}" if news["message"] else ""
        print(f"hexfill: {news['stage']} {news['done']}{of}{words}", file=sys.stderr)


class _Bar:
    """One bar, whatever the stage. It closes when it is forgotten, which is when the work ends."""

    def __init__(self, tqdm: Any) -> None:
        self.bar = tqdm(leave=False, dynamic_ncols=True, bar_format="{desc} {n_fmt}/{total_fmt} [{elapsed}] {postfix}")

    def __call__(self, news: dict[str, Any]) -> None:
        self.bar.total, self.bar.n = news["total"], news["done"]
        self.bar.set_description_str(news["stage"], refresh=False)
        self.bar.set_postfix_str(news["message"], refresh=False)
        self.bar.refresh()

    def __del__(self) -> None:
        self.bar.close()
