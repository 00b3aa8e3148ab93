"""Commands with results as Python objects.

Each is run as the command ``toile`` in a process of its own, since it starts processes for what it
measures and judges. Ctrl-C stops it as in a terminal.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Union

from toile._errors import Error, of_exit_code
from toile._toile import setting_words
from toile._values import Setting, as_json

_Path = Union[str, "os.PathLike[str]"]
_Paths = Union[_Path, Iterable[_Path]]

#: Exit codes of commands that have done what was asked: done, and limits that are missed.
_DONE = (0, 4)

#: The exit code of ``toile doctor`` where a stage fails.
_FAILING = 70


@dataclass(frozen=True)
class CommandOutput:
    """How a command ended."""

    #: 0 where all is good, 4 where limits are missed.
    exit_code: int
    #: What it printed on standard output.
    answer: str


def _options(options: Mapping[str, object]) -> list[str]:
    """Arguments of keywords: ``max_gap="1 mm"`` is ``--max-gap "1 mm"``; lists give several."""
    arguments: list[str] = []
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            arguments.append(option)
        elif isinstance(value, (list, tuple)):
            arguments += [f"{option}={_text(item)}" for item in value]
        else:
            arguments.append(f"{option}={_text(value)}")
    return arguments


def _text(value: object) -> str:
    return os.fspath(value) if isinstance(value, os.PathLike) else str(value)


def _listed(paths: _Paths) -> list[str]:
    if isinstance(paths, (str, os.PathLike)):
        return [os.fspath(paths)]
    return [os.fspath(path) for path in paths]


def _set(settings: Mapping[str, Setting] | None) -> list[str]:
    """Settings as ``--set`` takes them."""
    return [f"--set={words}" for words in setting_words(as_json(settings or {}))]


def _told(stream: IO[str], kept: list[str], echo: bool) -> None:
    for line in stream:
        kept.append(line)
        if echo and sys.stderr is not None:
            sys.stderr.write(line)


def _command(
    arguments: list[str], *, progress: bool = False, done: tuple[int, ...] = _DONE
) -> CommandOutput:
    """Runs the command; with ``progress`` it says on standard error how it goes on.

    Raises ``toile.Error`` for an exit code that is not one of ``done``.
    """
    quiet = [] if progress else ["--quiet"]
    process = subprocess.Popen(
        [sys.executable, "-m", "toile", *quiet, *arguments],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
        errors="replace",
    )
    assert process.stdout is not None and process.stderr is not None
    words: list[str] = []
    listener = threading.Thread(target=_told, args=(process.stderr, words, progress), daemon=True)
    listener.start()
    try:
        answer = process.stdout.read()
        exit_code = process.wait()
    except KeyboardInterrupt:
        # A notebook interrupts Python alone, a terminal both.
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
            process.wait()
        raise
    finally:
        process.stdout.close()
    listener.join()
    process.stderr.close()
    if exit_code not in done:
        raise _error(exit_code, answer, "".join(words))
    return CommandOutput(exit_code, answer)


def _error(exit_code: int, answer: str, words: str) -> Error:
    """What a command says of its failure, in JSON or in words."""
    kind = of_exit_code(exit_code)
    try:
        told: Any = json.loads(answer)
    except ValueError:
        told = None
    if isinstance(told, dict) and told.get("faults"):
        faults = told["faults"]
        first = faults[0]
        place = f"{first['file']}:{first['line']}:{first['column']}" if "file" in first else f"line {first['line']}"
        code = first.get("code", "invalid_input")
        return kind(first["message"], help=first.get("hint"), code=code, place=place, faults=faults)
    if isinstance(told, dict) and "message" in told:
        return kind(told["message"], help=told.get("hint"), code=told.get("error"))
    lines = words.strip().splitlines() or [f"the command ended with exit code {exit_code}"]
    message = lines[0].removeprefix("error: ")
    help_lines = [line.strip() for line in lines[1:]]
    texts = [line.removeprefix("help: ") for line in help_lines if line]
    return kind(message, help="\n".join(texts) or None)


def _json(output: CommandOutput) -> dict[str, Any]:
    told: dict[str, Any] = json.loads(output.answer)
    return told


def verify(
    garment: _Path,
    *,
    pattern: _Path | None = None,
    seams: _Path | None = None,
    set: Mapping[str, Setting] | None = None,
    body: _Path | None = None,
    compare: _Path | None = None,
    unit: str | None = None,
    up: str | None = None,
    max_gap: str | None = None,
    max_tight: int | None = None,
    fabric: str | None = None,
    friction: float | None = None,
    max_shift: str | None = None,
    out: _Path | None = None,
) -> dict[str, Any]:
    """Judges a finished garment from its files, as ``toile verify``; gives the certificate.

    ``certificate["verdict"]`` is ``"holds"`` or ``"fails"``, ``certificate["checks"]`` has each
    check. Lengths are texts with their unit, like ``"0.5 mm"``; ``max_tight`` is in percent.

    Raises ``toile.Error`` where the files cannot be read.
    """
    options = {
        "pattern": pattern,
        "seams": seams,
        "body": body,
        "compare": compare,
        "unit": unit,
        "up": up,
        "max_gap": max_gap,
        "max_tight": max_tight,
        "fabric": fabric,
        "friction": friction,
        "max_shift": max_shift,
        "out": out,
    }
    arguments = ["verify", "--json", *_options(options), *_set(set), "--", os.fspath(garment)]
    return _json(_command(arguments))


@dataclass(frozen=True)
class Batch:
    """How a batch ended."""

    #: How many garments the manifest has.
    garments: int
    #: How many of them are good.
    good: int
    #: How many ended with each fault.
    faults: dict[str, int]
    #: How many are left to be run.
    left: int
    #: Whether it was stopped.
    stopped: bool
    #: The folder of the results.
    folder: Path

    @property
    def results(self) -> list[dict[str, Any]]:
        """A line for each garment that is done, in the order of the manifest: ``results.jsonl``."""
        lines = (self.folder / "results.jsonl").read_text(encoding="utf-8").splitlines()
        return [json.loads(line) for line in lines]


def batch(
    manifest: _Path,
    *,
    pipeline: _Path,
    out: _Path | None = None,
    set: Mapping[str, Setting] | None = None,
    quality: str | None = None,
    shard: str | None = None,
    max_time: str | None = None,
    max_memory: str | None = None,
    memory: str | None = None,
    jobs: int | None = None,
    keep: Iterable[str] = (),
    until: str | None = None,
    verify: bool = True,
    only: Iterable[str] = (),
    retry_only: Iterable[str] = (),
    skip_faulty: bool = False,
    cache: Union[bool, _Path] = True,
    progress: bool = False,
) -> Batch:
    """Runs a pipeline for every garment of a manifest, as ``toile batch``, and goes on where it was
    stopped.

    Times are texts like ``"120s"``, sizes like ``"4 GB"``. ``progress`` says on standard error how
    it goes on. Garments that fail are results: ``Batch.faults`` counts them.

    Raises ``toile.Error`` where the manifest or the pipeline has faults, and nothing was run.
    """
    options = {
        "pipeline": pipeline,
        "out": out,
        "quality": quality,
        "shard": shard,
        "max_time": max_time,
        "max_memory": max_memory,
        "memory": memory,
        "jobs": jobs,
        "keep": list(keep),
        "until": until,
        "no_verify": not verify,
        "only": list(only),
        "retry_only": list(retry_only),
        "skip_faulty": skip_faulty,
        "no_cache": cache is False,
        "cache_dir": None if isinstance(cache, bool) else cache,
    }
    arguments = ["batch", "--json", *_options(options), *_set(set), "--", os.fspath(manifest)]
    told = _json(_command(arguments, progress=progress))
    return Batch(
        garments=told["garments"],
        good=told["good"],
        faults=told["faults"],
        left=told["left"],
        stopped=told["stopped"],
        folder=Path(told["folder"]),
    )


def manifest(
    sources: _Paths, *, field: str | None = None, out: _Path | None = None
) -> list[dict[str, Any]]:
    """A manifest of files or of a CSV table, as ``toile manifest``: a dictionary for each garment.

    ``field`` is the value that each file is, like ``"pattern.file"``; a table needs none. With
    ``out`` it is written there, and files are named as they are seen from there.
    """
    options = {"field": field, "out": out}
    output = _command(["manifest", *_options(options), "--", *_listed(sources)])
    text = output.answer if out is None else Path(out).read_text(encoding="utf-8")
    return [json.loads(line) for line in text.splitlines() if line.strip()]


def trade(
    pipeline: _Path,
    *,
    knobs: Iterable[str] = (),
    out: _Path | None = None,
    set: Mapping[str, Setting] | None = None,
    quality: str | None = None,
    until: str | None = None,
    points: int | None = None,
    starts: int | None = None,
    ablate: bool = False,
    budget: str | None = None,
    limit: str | None = None,
    repeats: int | None = None,
    jitter: str | None = None,
    reference: Iterable[str] = (),
    clock: str | None = None,
    threads: int | None = None,
    progress: bool = False,
) -> dict[str, Any]:
    """Measures accuracy against time, as ``toile trade``; gives the record of the measurement.

    ``knobs`` are what is varied, like ``"mesher.edge=6..24 mm"``; ``budget`` is the time for
    everything, like ``"5m"``. It takes minutes.
    """
    options = {
        "knob": list(knobs),
        "out": out,
        "quality": quality,
        "until": until,
        "points": points,
        "starts": starts,
        "ablate": ablate,
        "budget": budget,
        "limit": limit,
        "repeats": repeats,
        "jitter": jitter,
        "reference": list(reference),
        "clock": clock,
        "threads": threads,
    }
    arguments = ["trade", "--json", *_options(options), *_set(set), "--", os.fspath(pipeline)]
    return _json(_command(arguments, progress=progress))


def doctor(*stages: str, contracts: bool = False, plugins: Iterable[_Path] = ()) -> dict[str, Any]:
    """Tries stages on tiny input, as ``toile doctor``; all of them where none is named.

    ``contracts`` also holds them to what they promise. ``plugins`` are libraries, and files of
    Python whose stages are tried. Stages that fail are results: ``["failing"]`` counts them.
    """
    options = {"contracts": contracts}
    named = [part for plugin in plugins for part in ("--plugin", os.fspath(plugin))]
    arguments = [*named, "doctor", "--json", *_options(options), "--", *stages]
    output = _command(arguments, done=(0, _FAILING))
    found = _json(output)
    if "stages" not in found:
        raise _error(output.exit_code, output.answer, "")
    return found
