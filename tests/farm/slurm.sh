#!/usr/bin/env bash
# What `floe submit slurm` writes, run by a Slurm of its own on this machine: no root, no configuration of the system's.
#
#   tests/farm/slurm.sh [--install] [--keep]
#
# --install gets Debian's packages by apt (as root); without them, and without --install, nothing is tested.
# --keep leaves the folder with all logs. FLOE is the program [target/release/floe].
set -euo pipefail
cd "$(dirname "$0")/../.."
. tests/farm/common.sh

for argument in "$@"; do
    case $argument in
        --install) apt-get install -y --no-install-recommends slurmctld slurmd slurm-client ;;
        --keep) keep=yes ;;
        *) echo "unknown argument $argument; see the head of $0" >&2; exit 2 ;;
    esac
done
need sbatch slurmctld slurmd

export SLURM_CONF=$folder/slurm.conf
mkdir "$folder/state"

# Two nodes on this host, a processor each. `cred_expire`: or what is put into the queue again waits for two minutes.
configure() {
    cat > "$SLURM_CONF" <<END
ClusterName=floe
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=26817
AuthType=auth/none
AuthInfo=cred_expire=5
CredType=cred/none
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
StateSaveLocation=$folder/state
SlurmctldPidFile=$folder/slurmctld.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdSpoolDir=$folder/%n
SlurmdPidFile=$folder/%n.pid
SlurmdLogFile=$folder/%n.log
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,batch_sched_delay=0
ReturnToService=2
SlurmdTimeout=30
KillWait=5
JobRequeue=1
MaxArraySize=1001
NodeName=n1,n2 NodeHostname=$(hostname -s) NodeAddr=127.0.0.1 Port=26818,26819 CPUs=1 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
$1
END
}

slurmd_of() {
    slurmd -D -N "$1" -f "$SLURM_CONF" > "$folder/$1.out" 2>&1 &
    disown
}

# Daemons and whatever they started have the configuration in their environment.
ours() { grep -lz "^SLURM_CONF=$SLURM_CONF" /proc/[0-9]*/environ 2>/dev/null | cut -d/ -f3 | grep -vx "$$" || true; }
names() {
    local id
    for id in $(ours); do { echo "$id $(tr '\0' ' ' < "/proc/$id/cmdline")"; } 2> /dev/null || true; done
}
down() {
    scancel --full --user "$(id -un)" 2>/dev/null || true
    local id
    for id in $(names | awk '$2 ~ /slurm|floe/ { print $1 }'); do kill -KILL "$id" 2>/dev/null || true; done
}
on_exit down

# The process that renders a task of an array, or nothing.
renderer() {
    local id
    for id in $(names | awk '$2 ~ /floe$/ && $3 == "render" { print $1 }'); do
        if tr '\0' '\n' < "/proc/$id/environ" | grep -qx "SLURM_ARRAY_JOB_ID=$1" &&
            tr '\0' '\n' < "/proc/$id/environ" | grep -qx "SLURM_ARRAY_TASK_ID=$2"; then echo "$id"; fi
    done
}
running() { [ -n "$(renderer "$1" "$2")" ]; }
finished() { ! squeue --noheader --jobs "$1" 2>/dev/null | grep -q .; }
idle() { [ "$(sinfo --noheader --Node --states=idle | wc -l)" -ge "$1" ]; }
# `scancel` tries again when the job has already left, so it gets no time for that.
signal() { timeout 2 scancel --signal="$1" --batch "$2" || true; }
restarted() { scontrol show job "$1" | grep -q 'Restarts=[1-9]'; }
# Puts a folder of scripts into the queue, with further options; sets `render` and `check`.
submit() { read -r _ render _ check < <(sh "$1/submit.sh" "${@:2}" | tr -d ,); }
code() { scontrol show job "$1" | grep -o ' ExitCode=[0-9:]*' | cut -d= -f2; }

configure RequeueExit=75
slurmctld -D -f "$SLURM_CONF" > "$folder/slurmctld.out" 2>&1 &
disown
slurmd_of n1
slurmd_of n2
await "two nodes" idle 2

scene "$folder/a scene" 8 960
"$floe" render "$folder/a scene" --output "$folder/local/f_####.exr" --quiet > /dev/null

step "an array: one task killed, one told to stop; Slurm puts what ends with 75 into the queue again"
"$floe" submit slurm "$folder/a scene" --output "$folder/array/f_####.exr" --cpus 1 --time 10m --write "$folder/array job" 2> /dev/null
grep -q '^exec ' "$folder/array job/render.sbatch"
submit "$folder/array job"
await "task 2" running "$render" 2
kill -KILL "$(renderer "$render" 2)"
await "its end" eval "! running $render 2"
await "that it may be put into the queue again" scontrol requeue "${render}_2"
await "task 3" running "$render" 3
sleep 0.5
signal TERM "${render}_3"
await "the check" finished "$check"
[ "$(code "$check")" = 0:0 ]
restarted "${render}_3"
same local array

step "a node is lost in the middle of a frame"
"$floe" submit slurm "$folder/a scene" --output "$folder/nodes/f_####.exr" --tasks 4 --write "$folder/nodes job" 2> /dev/null
submit "$folder/nodes job"
await "a task on the second node" eval 'squeue --noheader --states=running --nodelist=n2 | grep -q .'
await "both tasks" eval "running $render 1 && running $render 2"
read -r task job < <(squeue --noheader --states=running --nodelist=n2 --format="%K %A")
# Daemons first, so that none of them tells what became of the renderer.
kill -KILL $(names | awk -v step="[$job.batch]" '/slurmd -D -N n2 / || ($2 == "slurmstepd:" && $3 == step) { print $1 }') \
    $(renderer "$render" "$task") 2> /dev/null || true
scontrol update NodeName=n2 State=DOWN Reason=lost   # as happens by itself after SlurmdTimeout
await "the check" finished "$check"
[ "$(code "$check")" = 0:0 ]
same local nodes
slurmd_of n2
scontrol update NodeName=n2 State=RESUME
await "two nodes" idle 2

step "without RequeueExit the script puts itself into the queue again"
configure ""
scene "$folder/long scene" 4 2400                  # so that no frame ends before it is told to
scontrol reconfigure
"$floe" submit slurm "$folder/long scene" --frames 0-3 --output "$folder/script/f_####.exr" --cpus 1 --write "$folder/script job" 2> /dev/null
! grep -q '^exec ' "$folder/script job/render.sbatch"
submit "$folder/script job"
await "both tasks" eval "running $render 1 && running $render 2"
kill -KILL "$(renderer "$render" 2)"              # no memory left
signal USR2 "${render}_1"                         # the time limit
await "task 3" running "$render" 3
sleep 0.5
scancel "${render}_3"                             # by a user: it is not to come back
await "the check" finished "$check"
[ "$(code "$check")" = 1:0 ]
restarted "${render}_1"
restarted "${render}_2"
[ "$("$floe" status "$folder/long scene" --frames 0-3 --output "$folder/script/f_####.exr" | tr -s ' \n' ' ')" = "complete 0,1,3 partial 2 " ]

step "frame i is simulated, meshed and rendered by three arrays, each when the one before it has its i"
scene "$folder/chain" 0 16
cat > "$folder/simulate.sbatch" <<END
#!/bin/sh
#SBATCH --array=1-6 --output=$folder/chain.log --open-mode=append
mkdir -p "$folder/chain/states"
cp "$PWD/sequences/iceberg/frames/frame_000\$SLURM_ARRAY_TASK_ID.ply" "$folder/chain/states/\$SLURM_ARRAY_TASK_ID.state"
END
cat > "$folder/mesh.sbatch" <<END
#!/bin/sh
#SBATCH --array=1-6 --output=$folder/chain.log --open-mode=append
mkdir -p "$folder/chain/frames"
gzip < "$folder/chain/states/\$SLURM_ARRAY_TASK_ID.state" > "$folder/chain/frames/.\$SLURM_ARRAY_TASK_ID" &&
mv "$folder/chain/frames/.\$SLURM_ARRAY_TASK_ID" "$folder/chain/frames/frame_000\$SLURM_ARRAY_TASK_ID.ply.gz"
END
sed -i 's/frame_####.ply/frame_####.ply.gz/' "$folder/chain/scene.toml"
"$floe" submit slurm "$folder/chain" --frames 1-6 --output "$folder/chained/f_####.exr" --write "$folder/chain job" 2> /dev/null
simulate=$(sbatch --parsable "$folder/simulate.sbatch")
mesh=$(sbatch --parsable --dependency="aftercorr:$simulate" --kill-on-invalid-dep=yes "$folder/mesh.sbatch")
submit "$folder/chain job" --dependency="aftercorr:$mesh" --kill-on-invalid-dep=yes
await "the check" finished "$check"
[ "$(code "$check")" = 0:0 ]
[ "$(find "$folder/chained" -name 'f_*.exr' | wc -l)" = 6 ]

if "$floe" merge --help > /dev/null 2>&1; then
    step "a frame in four ranges of its samples, by four tasks, and merged"
    cat > "$folder/parts.sbatch" <<END
#!/bin/sh
#SBATCH --array=0-3 --requeue --open-mode=append --output=$folder/parts.log
part=\$SLURM_ARRAY_TASK_ID
exec "$floe" render "$folder/a scene" --frames 0 --output "$folder/parts/f_####.exr" --resume --samples-range=\$((240 * part))..\$((240 * part + 240))
END
    parts=$(sbatch --parsable "$folder/parts.sbatch")
    merge=$(sbatch --parsable --dependency="afterany:$parts" --output="$folder/merge.log" \
        --wrap "'$floe' merge '$folder/a scene' --frames 0 --output '$folder/parts/f_####.exr'")
    await "the merge" finished "$merge"
    [ "$(code "$merge")" = 0:0 ]
    cmp "$folder/local/f_0000.exr" "$folder/parts/f_0000.exr"
fi

passed
