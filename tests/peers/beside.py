#!/usr/bin/env python3
"""Times the cloth engine beside peers on prepared scenes, in one run and one at a time, and judges both alike.

    TOILE_SHARED=FOLDER tests/peers/beside.py --python PYTHON_WITH_BPY [--newton PYTHON_WITH_NEWTON] \\
        [--scenes tube_2k2,tube_20k,...] [--runs 3]

FOLDER/bench holds make_scenes.py, metrics.py, peer_blender.py and peer_newton.py; PYTHON has numpy, libigl and bpy, and that
of --newton numpy, libigl, warp-lang and newton (its Style3D solver, 20 iterations, seams welded before the start). Scenes are made in
out/scenes. Our time is that of the stage `StaticEquilibrium` in `toile run pipelines/scene.ron`, without a cache, the best of the runs; a peer's is that of
its simulation alone. Without the folder it says "skipped".
"""
import argparse, json, os, pathlib, subprocess, sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
OUT = ROOT / "out" / "scenes"
SIZES = {"tube_2k2": "2k2", "tube_20k": "20k", "tube_100k": "100k", "drape_2k2": "2k2", "drape_20k": "20k",
         "hang_2k2": "2k2", "fall_1k": "1k"}


def call(*command):
    answer = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if answer.returncode not in (0, 4):
        sys.exit(f"{' '.join(map(str, command))}\n{answer.stdout}{answer.stderr}")
    return answer.stdout


def ours(scene, runs):
    best = None
    for _ in range(runs):
        out = OUT / f"{scene}_toile"
        text = call(ROOT / "target/release/toile", "run", ROOT / "pipelines/scene.ron",
                    "--set", f"scene.file={OUT / scene}.json", "--out", out, "--json", "--no-cache")
        metrics = json.loads(text)
        wall = next(s["wall_s"] for s in metrics["stages"] if s["id"] == "StaticEquilibrium")
        if best is None or wall < best[0]:
            best = (wall, metrics["garment"], out / "result.obj")
    return best


def judged(python, bench, scene, obj):
    return json.loads(call(python, bench / "metrics.py", OUT / f"{scene}.json", obj))


def blender(python, bench, scene):
    text = call(python, bench / "peer_blender.py", OUT / f"{scene}.json", OUT / f"{scene}_blender.obj",
                "--quality", "5", "--collision-quality", "2")
    return json.loads(text.strip().splitlines()[-1])


def newton(python, bench, scene):
    text = call(python, bench / "peer_newton.py", OUT / f"{scene}.json", OUT / f"{scene}_newton.obj",
                "--solver", "style3d")
    return json.loads(text.strip().splitlines()[-1])


def row(name, scene, wall, m, speed=""):
    area = max(m["panel_area_error"].values())
    cells = [scene, name, f"{wall:.2f}", f"{m.get('seam_gap_max_m', 0) * 1e3:.2f}", f"{m['strain_p99']:.2%}",
             f"{m['strain_max']:.2%}", f"{area:.2%}", m["self_crossing_triangle_pairs"], m.get("pen_vertices", 0),
             f"{m['com_y']:.3f}", speed]
    print("| " + " | ".join(map(str, cells)) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--python", required=True)
    parser.add_argument("--newton", metavar="PYTHON")
    parser.add_argument("--scenes", default="tube_2k2,drape_2k2,hang_2k2,tube_20k,drape_20k,tube_100k,fall_1k")
    parser.add_argument("--runs", type=int, default=3)
    args = parser.parse_args()
    shared = os.environ.get("TOILE_SHARED")
    if not shared or not (pathlib.Path(shared) / "bench").is_dir():
        return print("skipped: TOILE_SHARED names no folder with a bench")
    bench = pathlib.Path(shared) / "bench"
    scenes = args.scenes.split(",")
    OUT.mkdir(parents=True, exist_ok=True)
    kinds, sizes = {s.split("_")[0] for s in scenes}, {SIZES[s] for s in scenes}
    call(args.python, bench / "make_scenes.py", OUT, "--scenes", ",".join(sorted(kinds)), "--sizes", ",".join(sorted(sizes)))
    print("| scene | program | wall, s | gap, mm | strain p99 | greatest | area | crossings | in the body | centre y | greatest speed, m/s |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for scene in scenes:
        wall, garment, obj = ours(scene, args.runs)
        row("toile", scene, wall, judged(args.python, bench, scene, obj), f"{garment['max_speed_m_s']:.1e}")
        if scene in ("tube_100k", "fall_1k"):
            continue
        peers = [("Blender", blender, args.python)]
        peers += [("Newton", newton, args.newton)] if args.newton else []
        walls = []
        for name, peer, python in peers:
            figures = peer(python, bench, scene)
            walls.append((figures["wall_sim_s"], name))
            row(name, scene, figures["wall_sim_s"], figures)
        least, name = min(walls)
        print(f"|  | 1/20 of {name}'s is {least / 20:.3f} s; we take 1/{least / wall:.1f} |", flush=True)


main()
