"""Checks `kubernetes.yaml`, and runs its own command as the Job would, one process for each pod.

    python kubernetes.py JOB PIPELINE DATA

`DATA` stands for the volume; `DATA/set.jsonl` is the manifest. Four indexes run, two at a time, until each has ended as the
Job's policy says. The pod of index 2 is killed once.
"""

import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import kubernetes_validate
import yaml

INDEXES = 4
KILLED = 2

file, pipeline, data = map(Path, sys.argv[1:])
job = yaml.safe_load(file.read_text())
kubernetes_validate.validate(job, "1.33", strict=True)
spec = job["spec"]
pod = spec["template"]["spec"]
[container] = pod["containers"]

# What the schema does not say and the server refuses.
assert spec["completionMode"] == "Indexed" and pod["restartPolicy"] == "Never"
[on_exit] = [rule["onExitCodes"] for rule in spec["podFailurePolicy"]["rules"] if "onExitCodes" in rule]
assert on_exit["containerName"] == container["name"] and on_exit["operator"] == "In"
assert on_exit["values"] == sorted(set(on_exit["values"])) and 0 not in on_exit["values"]
volumes = {volume["name"] for volume in pod["volumes"]}
assert {mount["name"] for mount in container["volumeMounts"]} == volumes
# The number of shares stands in two places.
[words] = container["args"]
shares = f"/{spec['completions']} "
assert shares in words, words

for there, here in [
    (shares, f"/{INDEXES} "),
    ("/data/pipelines/pattern.ron", f"{pipeline} --quality Standard"),
    ("/data", str(data)),
]:
    assert there in words, there
    words = words.replace(there, here)


def pod_runs(index, is_killed):
    """The exit code of one pod."""
    environment = os.environ | {"JOB_COMPLETION_INDEX": str(index)}
    process = subprocess.Popen([*container["command"], words], env=environment, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    if is_killed:
        time.sleep(1.5)
        process.kill()
    return process.wait()


def index_runs(index):
    """The exit codes of an index's pods, until the policy says that there is no other."""
    codes = []
    while len(codes) <= spec["backoffLimitPerIndex"]:
        codes.append(pod_runs(index, index == KILLED and not codes))
        if codes[-1] in [0, *on_exit["values"]]:
            break
    return codes


with ThreadPoolExecutor(2) as pool:
    ran = list(pool.map(index_runs, range(INDEXES)))
print(f"    exit codes of the pods of each index: {ran}")
assert ran[KILLED][0] == -signal.SIGKILL and len(ran[KILLED]) == 2, ran
assert all(len(codes) == 1 for index, codes in enumerate(ran) if index != KILLED), ran
# The indexes with garments at fault are failed ones and not started again: skirt 7 is of index 2, skirt 18 of index 1.
assert [codes[-1] for codes in ran] == [0, 4, 4, 0], ran

# A manifest that is refused fails its index at once; a pod that is told to stop is one that is started again.
manifest = data / "set.jsonl"
whole = manifest.read_text()
manifest.write_text(whole + "no line of a manifest\n")
refused = index_runs(0)
manifest.write_text(whole)
assert refused == [3], refused
stopped = data / "stopped"
command = ["toile", "batch", str(manifest), "--pipeline", str(pipeline), "--out", str(stopped), "--no-cache", "--quiet"]
process = subprocess.Popen(command)
time.sleep(1.5)
process.terminate()
code = process.wait()
assert code == 5 and code not in on_exit["values"], code
print("    a refused manifest: 3, no second start; a pod that is told to stop: 5, a second start")
