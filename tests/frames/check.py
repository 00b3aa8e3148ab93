"""Blender opens what `Frames` writes, and finds the same places in every format.

    python tests/frames/check.py OUT      a run's output folder with motion.pc2, motion.glb, motion.usdz, ...

Needs `bpy` (Blender 5 as a Python module) and `numpy`.
"""

import struct
import sys
from pathlib import Path

import bpy
import numpy as np

# A hundredth of a millimetre is what USDZ is written to.
NEAR = 2e-5


def cache(path: Path) -> np.ndarray:
    """The places of a PC2 file: frames, points, 3."""
    data = path.read_bytes()
    assert data[:12] == b"POINTCACHE2\0", "the head of a PC2 file"
    version, points, start, rate, samples = struct.unpack("<iiffi", data[12:32])
    assert (version, start, rate) == (1, 0.0, 1.0), (version, start, rate)
    places = np.frombuffer(data[32:], "<f4").reshape(samples, points, 3)
    return places


def mdd(path: Path) -> np.ndarray:
    data = path.read_bytes()
    frames, points = struct.unpack(">ii", data[:8])
    return np.frombuffer(data[8 + 4 * frames :], ">f4").reshape(frames, points, 3)


def empty() -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)


def mesh() -> bpy.types.Object:
    return next(o for o in bpy.context.scene.objects if o.type == "MESH")


def places(obj: bpy.types.Object, frame: float) -> np.ndarray:
    """World places of the evaluated mesh at a frame of the scene, y up."""
    bpy.context.scene.frame_set(int(frame), subframe=frame - int(frame))
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    found = evaluated.to_mesh()
    x = np.empty(3 * len(found.vertices), np.float32)
    found.vertices.foreach_get("co", x)
    world = np.array(evaluated.matrix_world)
    x = x.reshape(-1, 3) @ world[:3, :3].T + world[:3, 3]
    evaluated.to_mesh_clear()
    return np.stack([x[:, 0], x[:, 2], -x[:, 1]], axis=1)


def same(what: str, found: np.ndarray, want: np.ndarray) -> None:
    assert found.shape == want.shape, f"{what}: {found.shape} and not {want.shape}"
    far = float(np.abs(found - want).max())
    assert far < NEAR, f"{what}: a place is {far} m off"
    print(f"{what}: {len(want)} vertices, the farthest {far * 1e6:.1f} um off")


def main(out: Path) -> None:
    want = cache(out / "motion.pc2")
    assert np.array_equal(want, mdd(out / "motion.mdd")), "PC2 and MDD differ"
    moved = float(np.abs(want[-1] - want[0]).max())
    assert moved > 1e-3, f"nothing moves: {moved} m"
    looks = sorted({0, 1, len(want) // 2, len(want) - 1})

    empty()
    bpy.ops.wm.obj_import(filepath=str(out / "motion" / "motion_0000.obj"))
    modifier = mesh().modifiers.new("motion", "MESH_CACHE")
    modifier.cache_format, modifier.filepath = "PC2", str(out / "motion.pc2")
    modifier.play_mode, modifier.frame_start = "SCENE", 0
    for axis, value in (("forward_axis", "POS_Y"), ("up_axis", "POS_Z")):
        setattr(modifier, axis, value)
    for k in looks:
        same(f"PC2, frame {k}", places(mesh(), k), want[k])

    empty()
    bpy.ops.import_scene.gltf(filepath=str(out / "motion.glb"))
    scene = bpy.context.scene
    rate = scene.render.fps / scene.render.fps_base
    times = np.frombuffer((out / "motion.mdd").read_bytes()[8 : 8 + 4 * len(want)], ">f4")
    for k in looks:
        # Blender may put the vertices of a GLB in another order: the sorted places are compared.
        same(f"GLB, frame {k}", ordered(places(mesh(), float(times[k]) * rate)), ordered(want[k]))

    empty()
    bpy.ops.wm.usd_import(filepath=str(out / "motion.usdz"))
    for k in looks:
        same(f"USDZ, frame {k}", places(mesh(), k), want[k])


def ordered(x: np.ndarray) -> np.ndarray:
    rounded = np.round(x, 4)
    return x[np.lexsort((rounded[:, 2], rounded[:, 1], rounded[:, 0]))]


if __name__ == "__main__":
    main(Path(sys.argv[1]))
