"""GarmentCode's own program reads what `PatternJson` writes.

    python3 -m venv venv
    venv/bin/pip install --no-deps pygarment==2.0.2
    venv/bin/pip install numpy scipy svgpathtools svgwrite matplotlib cairosvg pyyaml
    venv/bin/python tests/pygarment/check.py WRITTEN_specification.json [READ_specification.json]

The first file is one that `PatternJson` wrote; the second one, where it is given, is the file that the pattern was read from: both must then
have the same panels, as many stitches, and panels of the same area within 1 %. Ends with 0 where all is well, with 1 and a sentence for each
fault where it is not, with 2 where pygarment is missing.

The wheel of pygarment 2.0.2 keeps its parts beside its package and lacks a module that they import: both are put right here.
"""

import importlib.util
import pathlib
import sys
import types

SAMPLES = 40


def pygarment():
    """The class that reads a specification."""
    if importlib.util.find_spec("pygarment") is None:
        found = importlib.util.find_spec("pattern")
        if found is None or not found.submodule_search_locations:
            print("pygarment is not installed: see the head of this file", file=sys.stderr)
            sys.exit(2)
        package = types.ModuleType("pygarment")
        package.__path__ = [str(pathlib.Path(found.submodule_search_locations[0]).parent)]
        package.data_config = types.ModuleType("pygarment.data_config")
        sys.modules["pygarment"] = package
        sys.modules["pygarment.data_config"] = package.data_config
    from pygarment.pattern.wrappers import VisPattern

    return VisPattern


def outline(pattern, name):
    """Points of a panel's edges, curves followed."""
    panel = pattern.pattern["panels"][name]
    points = []
    for edge in panel["edges"]:
        curve = pattern._edge_as_curve(panel["vertices"], edge)
        points += [curve.point(t / SAMPLES) for t in range(SAMPLES)]
    return points


def area(points):
    return abs(sum((a.real * b.imag - b.real * a.imag) for a, b in zip(points, points[1:] + points[:1]))) / 2


def faults(written, read):
    if written.is_self_intersecting():
        yield "a panel crosses itself"
    panels = written.pattern["panels"]
    sewn = set()
    for k, stitch in enumerate(written.pattern["stitches"]):
        sides = stitch[:2]
        for side in sides:
            if side["edge"] >= len(panels[side["panel"]]["edges"]):
                yield f"stitch {k} names edge {side['edge']} of \"{side['panel']}\", which there is not"
                break
            if (side["panel"], side["edge"]) in sewn:
                yield f"edge {side['edge']} of \"{side['panel']}\" is stitched twice"
            sewn.add((side["panel"], side["edge"]))
        else:
            # The simulation takes no stitch whose edges have unlike labels.
            labels = {panels[s["panel"]]["edges"][s["edge"]].get("label") for s in sides} - {None}
            if len(labels) > 1:
                yield f"the edges of stitch {k} are labelled {sorted(labels)}"
    for name, panel in panels.items():
        ends = [e["endpoints"] for e in panel["edges"]]
        if any(a[1] != b[0] for a, b in zip(ends, ends[1:] + ends[:1])):
            yield f"the edges of \"{name}\" do not follow each other"
    if read is None:
        return
    if set(panels) != set(read.pattern["panels"]):
        yield f"panels {sorted(panels)}, in the file that was read {sorted(read.pattern['panels'])}"
        return
    counts = [len(p.pattern["stitches"]) for p in (written, read)]
    if counts[0] != counts[1]:
        yield f"{counts[0]} stitches, in the file that was read {counts[1]}"
    for name in panels:
        a, b = area(outline(written, name)), area(outline(read, name))
        if abs(a - b) > 0.01 * b:
            yield f"panel \"{name}\" has {a:.1f} cm2, in the file that was read {b:.1f}"


def main(files):
    if not 1 <= len(files) <= 2:
        print(__doc__, file=sys.stderr)
        return 2
    reader = pygarment()
    written, *read = (reader(file) for file in files)
    found = list(faults(written, read[0] if read else None))
    for fault in found:
        print(f"{files[0]}: {fault}")
    if not found:
        print(f"{files[0]}: {len(written.pattern['panels'])} panels, {len(written.pattern['stitches'])} stitches: read")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
