"""Writes a set of 24 garments, of which two fail: the sample skirt in 24 cloths.

    python garments.py SAMPLES DIR [COUNT]     only the first COUNT

`DIR/set.jsonl` is the manifest. Skirt 7 names a vertex that is not there; skirt 18 is so narrow that its cloth is stretched beyond the limit.
"""

import json
import shutil
import sys
from pathlib import Path

COUNT = 24

samples, folder = map(Path, sys.argv[1:3])
count = int(sys.argv[3]) if len(sys.argv) > 3 else COUNT
folder.mkdir(parents=True)
shutil.copy(samples / "scene" / "form.obj", folder)
skirt = json.loads((samples / "scene" / "skirt.json").read_text())

lines = []
for k in range(1, count + 1):
    scene = json.loads(json.dumps(skirt))
    scene["material"]["area_density"] = 0.1 + 0.01 * k
    scene["body"]["friction"] = 0.3 + 0.01 * k
    if k == 7:
        scene["triangles"][0][0] = 10**6
    if k == 18:
        scene["rest_uv"] = [[0.5 * u, v] for u, v in scene["rest_uv"]]
    name = f"skirt{k}"
    (folder / f"{name}.json").write_text(json.dumps(scene))
    lines.append(json.dumps({"id": name, "set": {"scene.file": f"{name}.json"}}) + "\n")
(folder / "set.jsonl").write_text("".join(lines))
