#!/bin/bash
# Renders through a small Slurm cluster that loses processes, tasks and a node meanwhile: the image must not show it.
#
# FROND, SCENE, SPP and OPTIONS choose another program, scene, number of samples and options than the stand-in's. A task should then take
# some seconds, or it is done before it is disturbed. Exits with 77 where Slurm is not installed.
set -euo pipefail

[[ ${FROND_SLOW_TESTS:-1} != 0 ]] || { echo "skipped: takes a minute, scripts/test --slow runs it" && exit 77; }

here=$(cd "$(dirname "$0")" && pwd)
templates=$here/../../src/jobs/submit/slurm
# A cluster that this test itself runs on has no say in the test's jobs.
unset "${!SLURM@}" "${!SBATCH@}"
export SOURCE_DATE_EPOCH=0 # images are compared byte for byte

tmp=$(mktemp -d /tmp/frond-slurm.XXXXXX)
cluster=$tmp/cluster
fake=$here/fake_frond
frond=${FROND:-$fake}
scene=${SCENE:-$tmp/a scene}
spp=${SPP:-100}
read -ra options <<<"${OPTIONS:-}" # of frond render, words without spaces
failures=0

finish() {
  local code=$?
  [[ ! -e $cluster/name ]] || "$here/cluster.sh" stop "$cluster" || code=1
  if ((code == 0 || code == 77)); then rm -rf "$tmp"; else echo "see $tmp" >&2; fi
  exit "$code"
}
trap finish EXIT
trap 'exit 1' INT TERM

say() { printf '%3d s  %s\n' "$SECONDS" "$1"; }

check() { # check WHAT COMMAND...
  local what=$1
  shift
  if "$@"; then say "ok: $what"; else
    say "FAILED: $what"
    failures=$((failures + 1))
  fi
}

soon() { # soon SECONDS COMMAND...: whether it comes true by then
  local deadline=$((SECONDS + $1))
  shift
  until "$@"; do
    ((SECONDS < deadline)) || return 1
    sleep 0.2
  done
}

await() { soon "$@" || { say "waited $1 s in vain for: ${*:2}" && exit 1; }; }

fill() { # fill TEMPLATE NAME=VALUE...: as "frond submit" does
  local text pair
  text=$(<"$templates/$1")
  shift
  text=${text//@OPTIONS@/} text=${text//@PART_OPTION@/}
  text=${text//@MERGE@/merge -o @OUT@}
  for pair in "$@"; do text=${text//"@${pair%%=*}@"/"$(printf %q "${pair#*=}")"}; done
  printf '%s\n' "$text"
}

# make_job NAME PROGRAM SPP TASKS [SED_EDIT]: a folder to submit, changed by SED_EDIT as a user would
make_job() {
  local job=$tmp/$1 template
  mkdir "$job"
  cp "$templates/submit.sh" "$job"
  chmod +x "$job/submit.sh"
  for template in render.sbatch merge.sbatch; do
    fill "$template" FROND="$2" SCENE="$scene" OUT="$job/out.exr" COMMAND=render AMOUNT_OPTION=--spp AMOUNT="$3" TASKS="$4" LAST_TASK=$(($4 - 1)) |
      sed -E "s/^checkpoint_seconds=.*/checkpoint_seconds=1/;${5:-}" >"$job/$template"
  done
}

# make_main NAME TASKS: the folder that "frond submit" makes, where there is a frond
make_main() {
  if [[ $frond == "$fake" ]]; then
    make_job "$1" "$frond" "$spp" "$2"
    return
  fi
  "$frond" submit "$scene" -o "$tmp/$1/out.exr" --folder "$tmp/$1" --spp "$spp" --tasks "$2" --engine slurm "${options[@]}"
  sed -Ei 's/^checkpoint_seconds=.*/checkpoint_seconds=1/' "$tmp/$1/render.sbatch"
}

# submit NAME SECONDS_PER_SAMPLE: submits it, as from within some other job, and sets array and merge to the numbers
submit() {
  local answer
  answer=$(cd / && FAKE_FROND_SECONDS=$2 SLURM_RESTART_COUNT=7 "$tmp/$1/submit.sh")
  [[ $answer =~ ^'array job '([0-9]+)', then merge job '([0-9]+)$ ]]
  array=${BASH_REMATCH[1]} merge=${BASH_REMATCH[2]}
  say "submitted \"$1\": $answer"
}

field() { scontrol -o show job "$1" | grep -oP "(?<=\b$2=)\S+"; } # field JOB NAME
is() { [[ $(field "$1" "$2" | sort -u) == "$3" ]]; }                # is JOB NAME VALUE: in all of an array's tasks
restarted() { (($(field "$1" Restarts) > 0)); }

checkpointed() { [[ -e $tmp/$1/parts/0000$2.part.checkpoint ]]; } # checkpointed NAME INDEX

frond_of() { # frond_of NAME INDEX: the process that renders this part
  local pid
  grep -lzx -- "parts/0000$2.part" /proc/[0-9]*/cmdline 2>/dev/null | cut -d/ -f3 | while read -r pid; do
    [[ ! /proc/$pid/cwd -ef $tmp/$1 ]] || echo "$pid"
  done
}

log_of() { cat "$tmp/$1"/logs/render_*_"$2".log; } # log_of NAME INDEX

echo "a scene" >"$tmp/a scene"
"$here/cluster.sh" start "$cluster" 4 >/dev/null
export SLURM_CONF=$cluster/slurm.conf
say "cluster of 4 nodes started"

# Four jobs share the cluster. The first meets its time limit, of which Slurm warns within half a minute here.
make_job "time limit" "$fake" 34 1 's/^(#SBATCH --time)=.*/\1=1/; s/^(#SBATCH --signal=B:TERM)@.*/\1@60/'
submit "time limit" 1
limited=$array limited_merge=$merge

printf '#!/bin/sh\nkill -KILL $$\n' >"$tmp/dies"
chmod +x "$tmp/dies"
make_job "always dies" "$tmp/dies" 10 1 's/^most_crashes=.*/most_crashes=1/'
submit "always dies" 0
dying=$array dying_merge=$merge

make_job "refuses" /bin/false 10 1
submit "refuses" 0
refused=$array refused_merge=$merge

# A folder's name with much that a shell might take for its own.
main="a job's \$HOME & \"more\""
make_main "$main" 6
submit "$main" 0.3
rendered=$array rendered_merge=$merge

await 30 checkpointed "$main" 0
kill -KILL "$(frond_of "$main" 0)"
say "killed frond of task 0"
await 30 checkpointed "$main" 1
scontrol requeue "${rendered}_1"
say "requeued task 1"
await 30 checkpointed "$main" 2
node=$(field "${rendered}_2" NodeList)
"$here/cluster.sh" fail "$cluster" "$node"
say "took away $node, which has task 2"
# The last task's job number is also the array's: a script that mistook one for the other would requeue them all.
await 30 checkpointed "$main" 5
# As Slurm does before the time limit. Not by scancel: when it asks a second time, it warns the next run as well.
kill -TERM $(($(ps -o ppid= -p "$(frond_of "$main" 5)")))
say "warned task 5 that its time ends"

check "what frond refuses is not tried again" soon 20 is "${refused}_0" ExitCode 1:0
check "... and not merged" soon 20 is "$refused_merge" JobState CANCELLED

check "the merge runs once the tasks are done" soon 120 is "$rendered_merge" JobState COMPLETED
for index in 0 1 2 5; do check "task $index went on after 1 restart" is "${rendered}_$index" Restarts 1; done
for index in 3 4; do check "task $index needed none" is "${rendered}_$index" Restarts 0; done
"$frond" render "$scene" -o "$tmp/single.exr" --spp "$spp" "${options[@]}"
check "the image is that of a single run" cmp "$tmp/single.exr" "$tmp/$main/out.exr"
if [[ $frond == "$fake" ]]; then
  for index in 0 1 2 5; do
    check "task $index went on from its checkpoint" grep -q "checkpoint has samples" <(log_of "$main" "$index")
  done
fi

check "a task that keeps dying is given up" soon 20 is "${dying}_0" ExitCode 137:0
check "... after one restart" is "${dying}_0" Restarts 1
check "... and not merged" soon 20 is "$dying_merge" JobState CANCELLED

make_job "cancelled" "$fake" 200 2
submit "cancelled" 0.2
cancelled=$array
await 30 checkpointed "cancelled" 1
scancel "$array"
say "cancelled the array job"
check "a cancelled job ends" soon 20 is "$array" JobState CANCELLED
check "... and so does its merge" soon 20 is "$merge" JobState CANCELLED

# Submitted again, all parts are there already.
submit "$main" 10
check "finished parts are not rendered again" soon 20 is "$merge" JobState COMPLETED

check "a render over its time limit is done in the end" soon 120 is "$limited_merge" JobState COMPLETED
check "... after a restart" restarted "${limited}_0"
check "the cancelled job stayed so" is "$cancelled" JobState CANCELLED

((failures == 0)) || { say "$failures failed" && exit 1; }
say "all passed"
