"""Compares the folder that an engine's tasks wrote with that of one undisturbed batch, to the bit.

    python compare.py REFERENCE OTHER

Compared are the names of all files and their content, with these left out: times, memory and threads (in `metrics.json`, in
`record.json`, and the whole of `costs.jsonl` and `report.html`), the locks, and the empty files of Snakemake. Where two builds of the program
wrote the folders, their versions and what follows from those are left out as well, and that is said.
"""

import json
import sys
from pathlib import Path

LEFT_OUT = {"costs.jsonl", "report.html"}
OF_ENGINES = ("locks/", "shares/")
MEASURED = {"wall_s", "used", "predicted", "threads", "peak_memory_bytes", "costs"}
OF_A_BUILD = {"version", "inputs", "ticket"}


def without(value, names):
    if isinstance(value, dict):
        return {key: without(inner, names) for key, inner in value.items() if key not in names}
    return [without(inner, names) for inner in value] if isinstance(value, list) else value


def lines(folder):
    return [json.loads(line) for line in (folder / "results.jsonl").read_text().splitlines()]


def content(folder, dropped):
    """What is compared: names of files, and for each its bytes, or its JSON without the fields that are dropped."""
    found = {}
    for path in sorted(p for p in folder.rglob("*") if p.is_file()):
        name = path.relative_to(folder).as_posix()
        if path.name in LEFT_OUT:
            found[name] = "left out"
        elif name == "results.jsonl":
            found[name] = without(lines(folder), dropped)
        elif path.name in {"record.json", "metrics.json", "origin.json"}:
            found[name] = without(json.loads(path.read_text()), MEASURED | dropped)
        else:
            found[name] = path.read_bytes()
    return {name: held for name, held in found.items() if not name.startswith(OF_ENGINES)}


reference, other = map(Path, sys.argv[1:])
versions = {line["version"] for folder in (reference, other) for line in lines(folder)}
dropped = OF_A_BUILD if len(versions) > 1 else set()
a, b = content(reference, dropped), content(other, dropped)
assert len(a) > 24 and "results.jsonl" in a, f"{reference} has no results: {sorted(a)}"
differ = sorted(name for name in a.keys() | b.keys() if a.get(name) != b.get(name))
if differ:
    sys.exit(f"{other} differs from {reference} in {len(differ)} files: {', '.join(differ[:10])}")
builds = f", but for the versions {' and '.join(sorted(versions))}" if dropped else ""
seconds = sum(json.loads(line)["seconds"] for line in (other / "costs.jsonl").read_text().splitlines())
print(f"    {len(a)} files and {len(lines(other))} lines are equal to the bit{builds}; garments took {seconds:.1f} s, added up")
