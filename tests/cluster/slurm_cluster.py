"""A Slurm on this machine: munge, a controller and some nodes, in a folder and on ports of their own, ended with their user."""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

# Debian's daemons stand where an ordinary user's PATH does not look.
os.environ["PATH"] += ":/usr/sbin:/sbin"

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "sinfo", "srun")

# A lost node is seen after SlurmdTimeout, and its tasks go back to the queue when its credentials have expired as well
# (slurm.conf(5), AuthInfo: 120 s by default). Tests have no time for either. The controller and the nodes need addresses
# of their own beside the host's first one, which 127.0.0.0/8 has plenty of.
SLURM_CONF = """\
ClusterName=skyloop-test
SlurmctldHost={host}(127.0.0.2)
SlurmctldPort={ports[0]}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge/socket,cred_expire=5
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
ReturnToService=2
SlurmdTimeout={timeout}
MessageTimeout=3
TCPTimeout=1
KillWait=2
MinJobAge=300
MaxArraySize=10001
MaxJobCount=20000
SchedulerType=sched/builtin
SchedulerParameters=batch_sched_delay=0,sched_min_interval=100000,sched_interval=1,default_queue_depth=1000
StateSaveLocation={folder}/controller
SlurmdSpoolDir={folder}/%n
SlurmctldPidFile={folder}/controller.pid
SlurmdPidFile={folder}/%n.pid
SlurmctldLogFile={folder}/controller.log
SlurmdLogFile={folder}/%n.log
PartitionName=main Nodes={names} Default=YES MaxTime=INFINITE State=UP
"""
NODE = "NodeName={name} NodeAddr=127.0.0.2 NodeHostname={host} Port={port} CPUs={cpus} State=UNKNOWN\n"


def missing():
    """What a cluster here lacks, in a sentence, or nothing."""
    absent = [name for name in PROGRAMS if shutil.which(name) is None]
    if absent:
        return f"{', '.join(absent)} not installed: apt-get install slurm-wlm munge"
    if os.geteuid() != 0:
        return "Slurm's daemons switch users, so they need root"
    done = subprocess.run(["unshare", "--pid", "--fork", "--mount-proc", "true"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return f"no namespaces here: {done.stderr.strip()}"
    return None


def free_ports(count):
    """Ports that nobody has now; all are looked for at once, so that they differ."""
    sockets = [socket.socket() for _ in range(count)]
    try:
        for one in sockets:
            one.bind(("127.0.0.2", 0))
        return [one.getsockname()[1] for one in sockets]
    finally:
        for one in sockets:
            one.close()


def processes_below(roots):
    """The numbers of all processes that descend from the given ones, with these."""
    children = {}
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            fields = (entry / "stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue
        children.setdefault(int(fields[1]), []).append(int(entry.name))
    found, queue = set(), list(roots)
    while queue:
        number = queue.pop()
        if number not in found:
            found.add(number)
            queue.extend(children.get(number, []))
    return found


class Cluster:
    """Up when it is entered, gone with everything it started when it is left."""

    def __init__(self, folder, nodes=2, cpus=1, timeout=4):
        self.folder = pathlib.Path(folder)
        self.folder.chmod(0o755)  # munge wants everybody to reach its socket
        self.names = [f"n{i + 1}" for i in range(nodes)]
        self.daemons = {}
        ports = free_ports(1 + nodes)
        host = socket.gethostname().split(".")[0]
        for name in ("controller", "munge", *self.names):
            (self.folder / name).mkdir()
        conf = SLURM_CONF.format(host=host, ports=ports, folder=self.folder, timeout=timeout, names=",".join(self.names))
        nodes_text = "".join(NODE.format(name=name, host=host, port=port, cpus=cpus)
                             for name, port in zip(self.names, ports[1:]))
        head, partition = conf.rsplit("PartitionName", 1)
        (self.folder / "slurm.conf").write_text(head + nodes_text + "PartitionName" + partition)
        (self.folder / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\n")
        key = self.folder / "munge/key"
        key.touch(mode=0o600)
        key.write_bytes(os.urandom(64))
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf")}

    def __enter__(self):
        try:
            munge = self.folder / "munge"
            self.start("munged", "munged", "--foreground", f"--key-file={munge}/key", f"--socket={munge}/socket",
                       f"--pid-file={munge}/pid", f"--log-file={munge}/log", f"--seed-file={munge}/seed")
            self.wait_for(lambda: (munge / "socket").exists(), "munge's socket")
            self.start("slurmctld", "slurmctld", "-c", "-D")
            for name in self.names:
                self.start_node(name)
            self.wait_for(lambda: self.states() == {name: "idle" for name in self.names}, "idle nodes")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        # Who is asked ends its children itself; nodes have everything of theirs in a namespace that ends with them.
        for name, daemon in self.daemons.items():
            if daemon.poll() is None:
                daemon.send_signal(signal.SIGKILL if name in self.names else signal.SIGTERM)
        for daemon in self.daemons.values():
            try:
                daemon.wait(timeout=10)
            except subprocess.TimeoutExpired:
                for number in processes_below([daemon.pid]):
                    os.kill(number, signal.SIGKILL)
                daemon.wait(timeout=10)

    def start(self, name, *command):
        with open(self.folder / f"{name}.out", "ab") as output:
            self.daemons[name] = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=output, stderr=output,
                                                  env=self.environment, start_new_session=True)

    def start_node(self, name):
        # A node's processes have a namespace of their own, so that they can all end at the same moment.
        self.start(name, "unshare", "--pid", "--fork", "--kill-child", "--mount-proc", "slurmd", "-D", "-N", name)

    def kill_node(self, name):
        """As if its power went: the daemon, its steps and what they run end at once. Gives how many they were."""
        unshare = self.daemons[name]
        inside = processes_below([unshare.pid]) - {unshare.pid}
        unshare.kill()
        unshare.wait(timeout=20)
        return len(inside)

    def states(self):
        told = subprocess.run(["sinfo", "--noheader", "--Node", "--format=%N %t"], env=self.environment, capture_output=True,
                              text=True, timeout=20, check=False).stdout
        return dict(line.split() for line in told.splitlines())

    def jobs(self):
        """The state of every task that Slurm still knows: {"JOB_TASK": "RUNNING"}."""
        told = subprocess.run(["squeue", "--noheader", "--array", "--states=all", "--format=%i %T"], env=self.environment,
                              capture_output=True, text=True, timeout=20, check=False).stdout
        return dict(line.split() for line in told.splitlines())

    def wait_for(self, happens, what, patience=30):
        end = time.monotonic() + patience
        while not happens():
            if time.monotonic() > end:
                raise AssertionError(f"no {what} in {patience} s; {self.logs()}")
            time.sleep(0.05)

    def logs(self):
        """The last lines of everybody, for a failure's report."""
        texts = []
        for path in sorted([*self.folder.glob("*.log"), *self.folder.glob("*.out")]):
            texts.append(f"== {path.name}\n" + "\n".join(path.read_text(errors="replace").splitlines()[-6:]))
        return "\n".join(texts)
