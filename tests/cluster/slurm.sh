#!/bin/sh
# The sweep on a real Slurm and under GNU parallel: `sh tests/cluster/slurm.sh [FRAMESIM]` (default build/framesim).
#
# Starts munged, slurmctld and slurmd of its own, on 127.0.0.1 and with a key of its own, all in a temporary folder;
# submits the job array of experiments/cluster/sweep.slurm, one task of which is killed half way; sees that the merge names
# that task, runs it again, merges, and compares with a single run byte for byte. No systemd, nothing outside the folder.
# Exit code 0: all held; 1: something did not; 77: skipped, and the last line says why.
set -u
cd "$(dirname "$0")/../.." || exit 1
. experiments/setup.sh

framesim=${1:-build/framesim}
case $framesim in /*) ;; *) framesim=$PWD/$framesim ;; esac
job=$PWD/experiments/cluster/sweep.slurm
folder=
pids=

stop() {
  for pid in $pids; do kill "$pid" 2>/dev/null; done
  for pid in $pids; do wait "$pid" 2>/dev/null; done
  [ -z "$folder" ] || rm -rf "$folder"
}
skip() { stop; say "skipped: $*"; exit 77; }
fail() {
  say "FAILED: $*" >&2
  for log in "$folder"/*.log "$folder"/log/*; do
    if [ -s "$log" ]; then say "-- $log"; tail -n 15 "$log"; fi >&2
  done
  stop
  exit 1
}
trap 'stop; exit 1' INT TERM HUP

# wait_for SECONDS COMMAND...: until it succeeds.
wait_for() {
  tries=$(($1 * 10))
  shift
  while ! "$@" >/dev/null 2>&1; do
    tries=$((tries - 1))
    [ "$tries" -gt 0 ] || return 1
    sleep 0.1
  done
}

# free_port: a port of 127.0.0.1 that nobody listens on (/proc/net/tcp has them in hexadecimal).
free_port() {
  port=$1
  while grep -qi ":$(printf %04X "$port") " /proc/net/tcp; do port=$((port + 1)); done
  echo "$port"
}

[ -x "$framesim" ] || fail "there is no program $framesim; build it first"
missing=$(missing_packages slurm-wlm munge parallel)
if [ -n "$missing" ]; then
  command -v apt-get >/dev/null 2>&1 || skip "no apt-get to install $missing"
  [ "$(id -u)" -eq 0 ] || command -v sudo >/dev/null 2>&1 || skip "not root, to install $missing"
  install_packages slurm-wlm munge parallel >/dev/null 2>&1 || skip "apt-get could not install $missing"
fi

folder=$(mktemp -d) || exit 1
chmod 755 "$folder"
mkdir "$folder/munge" "$folder/state" "$folder/spool" "$folder/log" "$folder/home"
chmod 700 "$folder/munge"
user=$(id -un)
host=$(hostname -s 2>/dev/null || hostname)

# A key of its own, so that nothing of this speaks to another Slurm.
dd if=/dev/urandom of="$folder/munge/key" bs=128 count=1 2>/dev/null
chmod 400 "$folder/munge/key"
munged --foreground --force --key-file="$folder/munge/key" --socket="$folder/munge.socket" \
  --pid-file="$folder/munge/pid" --log-file="$folder/log/munged" --seed-file="$folder/munge/seed" \
  >"$folder/log/munged.out" 2>&1 &
pids="$!"
wait_for 10 munge --socket="$folder/munge.socket" --no-input ||
  skip "munged does not start here: $(tail -n 1 "$folder/log/munged.out")"

controller_port=$(free_port 26817)
node_port=$(free_port $((controller_port + 1)))
cat >"$folder/slurm.conf" <<EOF
ClusterName=framesim
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CryptoType=crypto/munge
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmctldPort=$controller_port
SlurmdPort=$node_port
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldLogFile=$folder/log/slurmctld
SlurmdLogFile=$folder/log/slurmd
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,batch_sched_delay=0
MpiDefault=none
SwitchType=switch/none
ReturnToService=2
SlurmctldTimeout=30
SlurmdTimeout=30
MinJobAge=300
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(processors) State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=10 State=UP
EOF
SLURM_CONF=$folder/slurm.conf
export SLURM_CONF
slurmctld -D >"$folder/log/slurmctld.out" 2>&1 &
pids="$pids $!"
slurmd -D -N "$host" >"$folder/log/slurmd.out" 2>&1 &
pids="$pids $!"
# shellcheck disable=SC2317  # called by wait_for
node_idle() { [ "$(sinfo -h -o %t)" = idle ]; }
wait_for 30 node_idle || {
  why=$(sinfo -h -o '%t %E' 2>&1 | head -n 1)
  skip "slurmctld and slurmd do not come up here: $why; $(tail -q -n 1 "$folder/log/slurmd"* 2>/dev/null | tail -n 1)"
}
say "slurmctld and slurmd $(slurmd -V | cut -d' ' -f2) are up"

cat >"$folder/sweep.toml" <<'EOF'
framesim = 1
scenes = ["street", "graphicon-forest:trees=100"]
policies = ["robin-hood", "funkhouser", "static"]
effects = ["jitter:sigma=0.1"]
seeds = 100
frames = 60
EOF
"$framesim" sweep "$folder/sweep.toml" --store "$folder/single.sqlite" --quiet || fail "the single run"
"$framesim" query "$folder/single.sqlite" --format csv -o "$folder/single.csv" || fail "the single run's table"

# The program as a task has it: task 2 is killed (once) as soon as some of its runs are stored.
cat >"$folder/framesim" <<EOF
#!/bin/sh
[ "\$SLURM_ARRAY_TASK_ID" = 2 ] && [ ! -e "$folder/killed" ] || exec "$framesim" "\$@"
touch "$folder/killed"
"$framesim" "\$@" &
some='SELECT count(*) > 0 FROM run'
while ! "$framesim" query "$folder/parts/shard-2.sqlite" "\$some" --format csv 2>/dev/null | grep -q '^1\$'; do
  kill -0 \$! || exit 3
done
kill -9 \$!
wait \$!
EOF
chmod 755 "$folder/framesim"

# submit ARRAY: the job of experiments/cluster, and its end.
submit() {
  (cd "$folder" && SWEEP_SPEC=sweep.toml SWEEP_OUT=parts FRAMESIM="$folder/framesim" SWEEP_SHARDS="${2-}" \
    timeout 120 sbatch --wait --array="$1" --output="$folder/task-%a.log" "$job" 2>&1)
}

submit 0-3 && fail "a task was killed, and sbatch --wait did not say so"
"$framesim" merge "$folder/merged.sqlite" "$folder"/parts/shard-*.sqlite 2>"$folder/merge.log" && fail "merged without all runs"
grep -q 'shard 2/4 (.*shard-2.sqlite) has [0-9]* of 150 runs' "$folder/merge.log" ||
  fail "the merge does not name the task that failed"
say "found: $(grep -o 'shard 2/4.*runs' "$folder/merge.log" | sed "s#$folder/##")"
[ ! -e "$folder/merged.sqlite" ] || fail "a store was left by a merge that was refused"
submit 2 4 >"$folder/again.log" || fail "the task that failed, run again"
"$framesim" merge "$folder/merged.sqlite" "$folder"/parts/shard-*.sqlite || fail "merging"
"$framesim" query "$folder/merged.sqlite" --format csv -o "$folder/merged.csv" || fail "the merged table"
cmp "$folder/single.csv" "$folder/merged.csv" || fail "Slurm's shards merged are not the single run"
say "Slurm: 4 shards merged equal the single run, $(wc -c <"$folder/single.csv") bytes of table"

# GNU parallel, counted from 1.
HOME=$folder/home parallel -j 2 "$framesim" sweep "$folder/sweep.toml" --store "$folder/p-{}.sqlite" --shard '{}/3' \
  --resume --jobs 1 --quiet ::: 1 2 3 >"$folder/parallel.log" 2>&1 || fail "GNU parallel"
"$framesim" merge "$folder/p.sqlite" "$folder"/p-*.sqlite || fail "merging what GNU parallel made"
"$framesim" query "$folder/p.sqlite" --format csv -o "$folder/p.csv" || fail "the table of what GNU parallel made"
cmp "$folder/single.csv" "$folder/p.csv" || fail "GNU parallel's shards merged are not the single run"
say "GNU parallel: 3 shards merged equal the single run"
stop
exit 0
