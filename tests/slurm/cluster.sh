#!/bin/bash
# A Slurm cluster on this machine alone, for tests: all of it is in one folder, and its end leaves no process behind.
#
#   cluster.sh start DIR [NODES]   starts it, with 3 nodes unless told, and prints what to export
#   cluster.sh fail DIR NODE       takes a node away, as a power cut would
#   cluster.sh stop DIR            ends it; the folder stays, with its logs
#
# Needs no root. Exits with 77 where Slurm is not installed.
set -euo pipefail

PATH=$PATH:/usr/sbin:/sbin
usage="usage: cluster.sh start DIR [NODES] | fail DIR NODE | stop DIR"

die() {
  echo "cluster.sh: $1" >&2
  exit "${2:-1}"
}

until_true() { # until_true SECONDS COMMAND...
  local deadline=$((SECONDS + $1))
  shift
  until "$@"; do
    ((SECONDS < deadline)) || return 1
    sleep 0.1
  done
}

# Daemons carry a mark in their environment, by which they are found again; a node's keepers of jobs (slurmstepd) inherit
# it. Slurm writes a title over the front of their environment, so the mark stands last.
start_daemon() { # start_daemon NAME COMMAND...
  local name=$1
  shift
  setsid env FROND_TEST_CLUSTER="$dir/$name/" "$@" </dev/null >>"$dir/log/$name.log" 2>&1 &
}

having() { # having VARIABLE=PATTERN: the processes whose environment holds it
  { grep -lzx -- "$1" /proc/[0-9]*/environ || true; } 2>/dev/null | cut -d/ -f3 | sort
}

daemons() { having "FROND_TEST_CLUSTER=$dir/${1:-.*}/"; }
job_processes() { having "SLURM_CLUSTER_NAME=$(<"$dir/name")"; }
of_node() { daemons "$1" && comm -12 <(job_processes) <(having "SLURMD_NODENAME=$1"); }
of_cluster() { daemons && job_processes; }

send() { # send SIGNAL PID...: to those that are still there
  kill -s "$@" 2>/dev/null || true
}

kill_all() { # kill_all COMMAND...: kills what it lists until it lists nothing, since a process may have just forked
  local pids
  mapfile -t pids < <("$@")
  ((${#pids[@]})) || return 0
  send KILL "${pids[@]}"
  return 1
}

port_is_free() { ! (: <>"/dev/tcp/127.0.0.1/$1") 2>/dev/null; }

free_ports() { # free_ports COUNT: the first of COUNT free ports in a row, below those that the system hands out
  local first port
  for _ in {1..50}; do
    first=$((20000 + RANDOM % 10000))
    for ((port = first; port < first + $1; port++)); do port_is_free "$port" || continue 2; done
    echo "$first"
    return
  done
  die "found no free ports"
}

write_config() {
  local user host port
  user=$(id -un)
  host=$(hostname -s)
  port=$(free_ports $((nodes + 1)))
  cat >"$dir/slurm.conf" <<END
ClusterName=$(<"$dir/name")
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmUser=$user
SlurmdUser=$user
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool.%n
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.%n.pid

# Nothing that needs cgroups, a database or a second machine.
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none

# Quick where a real cluster is patient: a requeued job waits for cred_expire (120 s by default), a silent node is lost
# after SlurmdTimeout (300 s by default).
AuthType=auth/munge
AuthInfo=socket=$dir/munge.socket,cred_expire=5
SlurmdTimeout=5
KillWait=3
SchedulerParameters=batch_sched_delay=0,sched_interval=1,sched_min_interval=0,bf_interval=1

# As on many clusters, only jobs that ask for it are requeued.
JobRequeue=0

# As large as a job may ask for, whatever this machine has.
SlurmdParameters=config_overrides
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
NodeName=node[1-$nodes] NodeHostname=$host NodeAddr=127.0.0.1 Port=[$((port + 1))-$((port + nodes))] CPUs=4 RealMemory=65536
PartitionName=test Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
}

none() { [[ -z $("$@") ]]; }

nodes_are_idle() { [[ $(timeout 2 sinfo -h -N -p test -t idle -o %N 2>/dev/null | wc -l) == "$nodes" ]]; }

start() {
  local tool node
  for tool in munged slurmctld slurmd sbatch; do
    command -v "$tool" >/dev/null ||
      die "$tool is not installed (Debian: apt-get install munge slurmctld slurmd slurm-client)" 77
  done
  # Slurm makes sockets in it, whose paths end at 107 characters, and its configuration knows no quotes.
  [[ $dir =~ ^[A-Za-z0-9/._-]{1,60}$ ]] || die "the folder's path must be short, without spaces: $dir"
  [[ ! -e $dir/slurm.conf ]] || die "$dir already holds a cluster"

  mkdir -p "$dir/state" "$dir/log"
  echo "frond-test-$$-$RANDOM" >"$dir/name"
  (umask 077 && head -c 128 /dev/urandom >"$dir/munge.key")
  write_config
  export SLURM_CONF=$dir/slurm.conf

  trap 'tail -n 5 "$dir"/log/*.log >&2; stop' EXIT
  # --force: munged would want every user to have a way to its socket; here only one needs it.
  start_daemon munged munged --foreground --force --key-file="$dir/munge.key" --socket="$dir/munge.socket" \
    --pid-file="$dir/munged.pid" --seed-file="$dir/munge.seed"
  until_true 10 test -S "$dir/munge.socket" || die "munged does not start, see $dir/log"
  start_daemon slurmctld slurmctld -D
  for ((node = 1; node <= nodes; node++)); do start_daemon "node$node" slurmd -D -N "node$node"; done
  until_true 30 nodes_are_idle || die "the nodes are not idle after 30 s, see $dir/log"
  trap - EXIT

  echo "export SLURM_CONF=$dir/slurm.conf"
}

# Only together is it like a power cut: with slurmd alone gone, the node's jobs would go on.
fail() { until_true 10 kill_all of_node "$node" || die "$node has processes that do not end"; }

stop() {
  local pids
  [[ -e $dir/name ]] || die "$dir holds no cluster"
  mapfile -t pids < <(daemons)
  send TERM "${pids[@]}"
  until_true 2 none of_cluster || until_true 10 kill_all of_cluster || die "$dir has processes that do not end"
}

(($# >= 2)) || die "$usage" 2
dir=$(realpath -m -- "$2")
case $1:$# in
  start:[23]) nodes=${3:-3} && start ;;
  fail:3) node=$3 && fail ;;
  stop:2) stop ;;
  *) die "$usage" 2 ;;
esac
