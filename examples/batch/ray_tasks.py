"""A batch as tasks of Ray. Each task runs its share of the manifest, and all write one folder.

    pip install ray and the wheel of toile, on all machines
    python ray_tasks.py set.jsonl --pipeline pattern.ron --out out/set --shares 16

Take as many shares as give each some hundreds of garments. Paths are those of a file system that all machines see.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import ray
import toile


# A worker that dies is started again, and goes on where it was. A manifest that is refused raises `toile.Error`, which Ray
# does not try again; garments that fail are results.
@ray.remote(max_retries=3)
def share(number: int, count: int, jobs: int, manifest: Path, options: dict) -> int:
    toile.batch(manifest, shard=f"{number}/{count}", jobs=jobs, **options)
    return number


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("manifest", type=Path)
    parser.add_argument("--pipeline", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--shares", type=int, required=True)
    parser.add_argument("--jobs", type=int, default=8, help="cores of a task, a garment on each")
    parser.add_argument("--memory-gb", type=int, default=16, help="memory of a task")
    parser.add_argument("--quality")
    parser.add_argument("--max-time")
    parser.add_argument("--no-cache", action="store_true")
    parser.add_argument("--address", help="of a cluster that runs, like auto; without one, this machine")
    parser.add_argument("--cores", type=int, help="cores of this machine, where there is no cluster")
    args = parser.parse_args()

    manifest = args.manifest.absolute()
    options = {
        "pipeline": args.pipeline.absolute(),
        "out": args.out.absolute(),
        "quality": args.quality,
        "max_time": args.max_time,
        "cache": not args.no_cache,
    }
    ray.init(address=args.address, num_cpus=None if args.address else args.cores)
    task = share.options(num_cpus=args.jobs, memory=args.memory_gb * 10**9)
    of_task = options | {"memory": f"{args.memory_gb} GB"}
    waiting = [task.remote(n, args.shares, args.jobs, manifest, of_task) for n in range(1, args.shares + 1)]
    while waiting:
        [done], waiting = ray.wait(waiting)
        print(f"share {ray.get(done)} of {args.shares} is done", flush=True)
    # The whole manifest: all is done by now, and the results of all are written.
    batch = toile.batch(manifest, **options)
    print(f"{batch.garments} garments: {batch.good} good", *(f"{n} {kind}" for kind, n in batch.faults.items()), sep=", ")


if __name__ == "__main__":
    main()
