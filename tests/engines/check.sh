#!/usr/bin/env bash
# Runs the same 24 garments through every engine of examples/batch, and compares what is written with one undisturbed batch, to
# the bit. Slurm, munge and buildah come from Debian, Ray and Snakemake from the Python index. Root starts it, since Slurm's daemons are root's.
#
#     tests/engines/check.sh [slurm] [snakemake] [kubernetes] [ray] [container] [s3]     all without a name
#
# TOILE is the program, built anew without one; TOILE_STORES the one with object stores, for s3; WHEEL is the wheel, the newest of
# python/target/wheels without one, which s3 alone does not need. GARMENTS is how many of the 24 are run, at least 7, of which one fails.
set -euo pipefail
cd "$(dirname "$0")/../.."
root="$PWD"

engines=("$@")
[ ${#engines[@]} -gt 0 ] || engines=(slurm snakemake kubernetes ray container s3)

if [ -z "${TOILE:-}" ]; then
    cargo build --release --locked -p toile
    TOILE="${CARGO_TARGET_DIR:-target}/release/toile"
fi
environment=target/engines
[ -x "$environment/bin/pip" ] || python3 -m venv "$environment"
if [ "${engines[*]}" != s3 ]; then
    # shellcheck disable=SC2012
    wheel="${WHEEL:-$(ls -t python/target/wheels/*.whl | head -1)}"
    "$environment/bin/pip" install --quiet -r tests/engines/requirements.txt "$wheel"
    # One of the same version may be there.
    "$environment/bin/pip" install --quiet --no-deps --force-reinstall "$wheel"
fi
# The wheel brings a command `toile` of its own: where there are two, the program comes first.
scratch="$(mktemp -d)"
chmod 755 "$scratch"
mkdir "$scratch/bin"
cp "$TOILE" "$scratch/bin/toile"
export PATH="$scratch/bin:$root/$environment/bin:$PATH"

export RAY_USAGE_STATS_ENABLED=0

daemons=()
ended() {
    code=$?
    trap - EXIT
    if [ "$code" -ne 0 ]; then tail -n 20 "$scratch"/*.log 2>/dev/null || true; fi
    # Jobs outlive the daemons that started them.
    if [ -n "${SLURM_CONF:-}" ]; then
        scancel --quiet --user="$(id -un)" || true
        awaited slurm_has_no_job || true
    fi
    # In the reverse order: the node, its controller, munge.
    for ((i = ${#daemons[@]} - 1; i >= 0; i--)); do
        if kill "${daemons[i]}" 2>/dev/null; then wait "${daemons[i]}" 2>/dev/null || true; fi
    done
    rm -rf "$scratch"
    exit "$code"
}
trap ended EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

pipeline="$root/pipelines/scene.ron"
set_file="$scratch/set/set.jsonl"
options=(--quality Standard --no-cache)
python tests/engines/garments.py pipelines/samples "$scratch/set" "${GARMENTS:-24}"

# Runs a step to its first failure, and says what it took. No caller may ask for its result: that would let failures pass.
timed() {
    local name=$1 start code
    shift
    start="$(date +%s.%N)"
    set +e
    (
        set -e
        "$@"
    ) >"$scratch/$name.log" 2>&1
    code=$?
    set -e
    LC_ALL=C printf '%s: %.1f s\n' "$name" "$(echo "$(date +%s.%N) - $start" | bc)"
    return "$code"
}

# Waits until a command succeeds, five minutes at most.
awaited() {
    local tries=0
    until "$@"; do
        tries=$((tries + 1))
        if [ "$tries" -gt 1500 ]; then
            echo "waited five minutes for: $*"
            return 1
        fi
        sleep 0.2
    done
}

# The folder of an engine against the undisturbed one.
compared() { python tests/engines/compare.py "$scratch/reference" "$1"; }

# Some of the garments fail, so the exit code is 4.
undisturbed() {
    local code=0
    toile batch "$set_file" --pipeline "$pipeline" --out "$1" "${options[@]}" || code=$?
    test "$code" -eq 4
}

# Installs Debian's packages where a program is missing: PROGRAM... -- PACKAGE...
installed() {
    local missing=no
    while [ "$1" != -- ]; do
        command -v "$1" >/dev/null || missing=yes
        shift
    done
    shift
    [ "$missing" = no ] && return
    apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends "$@"
}

# One controller and one node on this machine, in a folder of their own.
slurm_started() {
    local home="$scratch/slurm" host
    host="$(hostname -s)"
    mkdir -p "$home/state" "$home/spool"
    head -c 1024 /dev/urandom >"$home/munge.key"
    chmod 400 "$home/munge.key"
    munged --foreground --key-file "$home/munge.key" --socket "$home/munge.socket" --pid-file "$home/munge.pid" \
        --seed-file "$home/munge.seed" --log-file "$home/munge.log" >"$scratch/munged.log" 2>&1 &
    daemons+=($!)
    cat >"$home/slurm.conf" <<CONF
ClusterName=toile
SlurmctldHost=$host(127.0.0.1)
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
SlurmUser=root
SlurmctldPort=36817
SlurmdPort=36818
AuthType=auth/munge
AuthInfo=socket=$home/munge.socket
CredType=cred/munge
StateSaveLocation=$home/state
SlurmdSpoolDir=$home/spool
SlurmctldPidFile=$home/slurmctld.pid
SlurmdPidFile=$home/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/affinity
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerParameters=sched_interval=2,bf_interval=2
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=4000
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
    export SLURM_CONF="$home/slurm.conf"
    awaited test -S "$home/munge.socket"
    slurmctld -D >"$scratch/slurmctld.log" 2>&1 &
    daemons+=($!)
    slurmd -D >"$scratch/slurmd.log" 2>&1 &
    daemons+=($!)
    awaited slurm_is idle
}

slurm_is() { [ "$(sinfo --noheader --format=%T 2>/dev/null)" = "$1" ]; }

slurm_has_no_job() { [ "$(squeue --noheader 2>&1)" = "" ]; }

# An array of four, and the job after it. With `cancelled` task 2 is cancelled while it runs, and the job after runs what that left.
slurm() {
    local array last size=(--cpus-per-task=1 --mem=1500M --chdir="$scratch")
    local job=("$root/examples/batch/slurm.sh" "$set_file" "$pipeline" "$1")
    array="$(sbatch --parsable "${size[@]}" --array=1-4 "${job[@]}" "${options[@]}")"
    if [ "${2:-}" = cancelled ]; then
        # The first of its six garments is done.
        awaited test -d "$1/garments/skirt2"
        scancel "${array}_2"
    fi
    last="$(sbatch --parsable "${size[@]}" --dependency="afterany:$array" "${job[@]}" "${options[@]}")"
    awaited slurm_has_no_job
    squeue --states=all --noheader --sort=V --format='    job %i: %T, submitted %V, started %S, ended %e'
    test "$(squeue --states=all --noheader --jobs="$last" --format=%T)" = COMPLETED
}

snakemake_run() {
    snakemake -s examples/batch/Snakefile --cores 2 --directory "$scratch" --config manifest="$set_file" \
        pipeline="$pipeline" out="$1" shares=4 threads=1 options="${options[*]}"
}

# With `killed` the first worker that has a share is killed, as if its machine had gone down.
ray_run() {
    if [ "${2:-}" = killed ]; then
        awaited worker_is_killed "$1" &
    fi
    python examples/batch/ray_tasks.py "$set_file" --pipeline "$pipeline" --out "$1" --shares 4 --jobs 1 --memory-gb 1 --cores 2 \
        --quality Standard --no-cache
}

worker_is_killed() {
    local worker processes
    [ -d "$1/garments" ] || return 1
    processes="$(ps -eo ppid,args)"
    worker="$(awk -v out="--out=$1 " '/ batch / && /--shard/ && index($0, out) { print $1; exit }' <<<"$processes")"
    [ -n "$worker" ] && kill -9 "$worker"
}

# The image's last stage on a Debian that is made here, with the program that is built already in place of the first stage, and
# the batch in a container of it. No daemon is needed.
container() {
    local store=(--storage-driver vfs --root "$scratch/images" --runroot "$scratch/containers") name
    hadolint examples/batch/Containerfile
    mkdir -p "$scratch/built/source/target/release" "$scratch/nothing" "$1"
    cp "$TOILE" "$scratch/built/source/target/release/toile"
    debootstrap --variant=minbase bookworm "$scratch/debian"
    tar -C "$scratch/debian" -cf "$scratch/debian.tar" .
    rm -rf "$scratch/debian"
    printf 'FROM scratch\nADD debian.tar /\n' |
        buildah "${store[@]}" bud --isolation chroot -f - -t docker.io/library/debian:bookworm-slim "$scratch"
    buildah "${store[@]}" bud --isolation chroot --build-context "build=$scratch/built" -f examples/batch/Containerfile \
        -t toile "$scratch/nothing"
    echo "size: $(buildah "${store[@]}" images --format '{{.Name}} {{.Size}}' | paste -sd ';')"
    name="$(buildah "${store[@]}" from toile)"
    # Its user is not root.
    chown -R 1000 "$1"
    buildah "${store[@]}" run --isolation chroot -v "$scratch/set:/data:ro" -v "$root/pipelines:/pipelines:ro" -v "$1:/out" "$name" -- \
        toile batch /data/set.jsonl --pipeline /pipelines/scene.ron --out /out "${options[@]}" || test $? -eq 4
    test "$(stat -c %u "$1/results.jsonl")" -eq 1000
    buildah "${store[@]}" rm "$name"
}

# A server of S3 from the Python index, and the manifest with its files in a bucket.
s3_started() {
    local port
    "$environment/bin/pip" install --quiet -r tests/engines/requirements-s3.txt
    port="$(python -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')"
    export AWS_ACCESS_KEY_ID=toile AWS_SECRET_ACCESS_KEY=toile AWS_REGION=us-east-1 AWS_DEFAULT_REGION=us-east-1
    export AWS_ENDPOINT_URL="http://127.0.0.1:$port" AWS_ALLOW_HTTP=true
    moto_server -H 127.0.0.1 -p "$port" >"$scratch/moto.log" 2>&1 &
    daemons+=($!)
    awaited python tests/engines/s3.py make toile "$scratch/set" in 2>"$scratch/s3_started.log"
}

# Two shares, each in an empty folder of its own. The first one is killed when its second garment is in the store, and started
# again in another empty folder.
s3() {
    local code=0 killed other
    local batch=("$stores" batch s3://toile/in/set.jsonl --pipeline "$pipeline" --out s3://toile/out "${options[@]}" --jobs 1)
    "${batch[@]}" --shard 2/2 --work "$scratch/work/second" &
    other=$!
    "${batch[@]}" --shard 1/2 --work "$scratch/work/killed" &
    killed=$!
    awaited python tests/engines/s3.py has toile out/garments/skirt3/record.json
    kill -9 "$killed"
    wait "$killed" || code=$?
    test "$code" -eq 137
    echo "    killed; in the store are $(python tests/engines/s3.py count toile out/ /record.json) records"
    code=0
    "${batch[@]}" --shard 1/2 --work "$scratch/work/first" || code=$?
    # A garment of this share fails.
    test "$code" -eq 4
    wait "$other" || test $? -eq 4
    python tests/engines/s3.py fetch toile out "$1"
}

# The results of all shares once more, from an empty folder, when nobody has written them.
s3_merged() {
    local batch=("$stores" batch s3://toile/in/set.jsonl --pipeline "$pipeline" --out s3://toile/out "${options[@]}")
    python tests/engines/s3.py remove toile out/results.jsonl out/costs.jsonl out/index.html
    "${batch[@]}" --merge --work "$scratch/work/merged" || test $? -eq 4
    test ! -d "$scratch/work/merged/garments"
    python tests/engines/s3.py fetch toile out "$1"
    # And a bucket that is not there.
    "${batch[@]/s3:\/\/toile\/out/s3://none/out}" --work "$scratch/work/none" || test $? -eq 3
}

timed undisturbed undisturbed "$scratch/reference"

for engine in "${engines[@]}"; do
    case "$engine" in
        slurm)
            if ! installed slurmctld slurmd sbatch munged -- slurm-wlm munge >"$scratch/apt.log" 2>&1; then
                echo "skipped: Slurm: its packages cannot be installed: $(tail -1 "$scratch/apt.log")"
                continue
            fi
            slurm_started
            timed slurm slurm "$scratch/slurm_out"
            grep '^    job' "$scratch/slurm.log"
            compared "$scratch/slurm_out"
            timed slurm_cancelled slurm "$scratch/cancelled" cancelled
            grep 'CANCELLED' "$scratch/slurm_cancelled.log"
            compared "$scratch/cancelled"
            ;;
        snakemake)
            timed snakemake snakemake_run "$scratch/snakemake_out"
            compared "$scratch/snakemake_out"
            timed snakemake_again snakemake_run "$scratch/snakemake_out"
            grep -q 'Nothing to be done' "$scratch/snakemake_again.log"
            ;;
        kubernetes)
            timed kubernetes python tests/engines/kubernetes.py examples/batch/kubernetes.yaml "$pipeline" "$scratch/set"
            grep '^ ' "$scratch/kubernetes.log"
            compared "$scratch/set/out/set"
            ;;
        ray)
            timed ray ray_run "$scratch/ray_out"
            compared "$scratch/ray_out"
            timed ray_killed ray_run "$scratch/ray_killed" killed
            grep -q 'the task will be retried' "$scratch/ray_killed.log"
            compared "$scratch/ray_killed"
            ;;
        container)
            if ! installed debootstrap buildah -- debootstrap buildah >"$scratch/apt.log" 2>&1; then
                echo "skipped: the container: its packages cannot be installed: $(tail -1 "$scratch/apt.log")"
                continue
            fi
            timed container container "$scratch/container_out"
            grep '^size: ' "$scratch/container.log" | sed 's/^/    /'
            compared "$scratch/container_out"
            ;;
        s3)
            stores="${TOILE_STORES:-}"
            if [ -z "$stores" ]; then
                cargo build --release --locked -p toile --features object-store --target-dir target/stores
                stores="$root/target/stores/release/toile"
            fi
            s3_started
            timed s3 s3 "$scratch/s3_out"
            grep '^    killed' "$scratch/s3.log"
            # What the killed one had sent is not run again.
            grep -E 'in this share: [0-9]+ to run, [1-9][0-9]* done' "$scratch/s3.log" | sed 's/^/    /'
            compared "$scratch/s3_out"
            timed s3_merged s3_merged "$scratch/s3_merged"
            grep -A 1 '^error: there is no bucket "s3://none"' "$scratch/s3_merged.log" | sed 's/^/    /'
            compared "$scratch/s3_merged"
            ;;
        *)
            echo "no such engine: $engine"
            exit 2
            ;;
    esac
done
echo "all engines: equal to one undisturbed batch"
