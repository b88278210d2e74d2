#!/usr/bin/env bash
# A Slurm cluster of this machine alone, in the given folder, until it is told to end: with accounts and ports of its own, beside whatever
# is installed. SLURM_CONF=FOLDER/slurm.conf makes sbatch and srun use it.
set -euo pipefail
folder=$1 user=$(id -un) host=$(hostname -s)
mkdir -p "$folder"/{state,spool,munge}
chmod 700 "$folder/munge"
free_port() { python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }
cat >"$folder/slurm.conf" <<CONF
ClusterName=chicane
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
CredType=cred/munge
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SchedulerParameters=sched_interval=1,batch_sched_delay=0
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP OverSubscribe=YES
CONF
head -c 1024 /dev/urandom >"$folder/munge/key"
chmod 400 "$folder/munge/key"
export SLURM_CONF=$folder/slurm.conf
children=()
trap 'for child in "${children[@]}"; do kill "$child" 2>/dev/null || true; done; wait 2>/dev/null; exit 0' TERM INT EXIT
munged --foreground --force --key-file="$folder/munge/key" --socket="$folder/munge/socket" --pid-file="$folder/munge/pid" \
  --log-file="$folder/munge/log" --seed-file="$folder/munge/seed" &
children+=($!)
until [ -S "$folder/munge/socket" ]; do sleep 0.1; done
slurmctld -D -f "$folder/slurm.conf" >"$folder/ctld.out" 2>&1 &
children+=($!)
sleep 1
slurmd -D -f "$folder/slurm.conf" -N "$host" >"$folder/d.out" 2>&1 &
children+=($!)
wait
