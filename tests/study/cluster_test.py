"""A study's cells by Snakemake and by Slurm give the tables that `study run` gives; interrupted, they go on.

    python3 tests/study/cluster_test.py SOURCE BUILD [snakemake|slurm]

Slurm: a controller and one node on this machine, of this test's own, started and stopped by it; needs root.
"""

import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

STUDY = """
scene = "{scene}"
unit = "mm"

[options]
vertex_rays = 16
rays = 64

[vary]
refine = ["none", "both"]
max_elements = [300, 500, 800]

[reference]
points = 100
paths = 64
"""

SLURM = """
ClusterName=patchlight
SlurmctldHost={host}(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmUser=root
SlurmctldPort={controller_port}
SlurmdPort={node_port}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
MpiDefault=none
SwitchType=switch/none
ReturnToService=2
MailProg=/bin/true
SchedulerParameters=sched_interval=1,batch_sched_delay=0
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def files(folder):
    """All that doesn't depend on clock or machine, with its bytes."""
    return {str(p.relative_to(folder)): p.read_bytes()
            for p in sorted(folder.rglob("*")) if p.is_file() and p.name != "timing.json"}


def check_same(found, expected, how):
    a, b = files(found), files(expected)
    missing, extra = sorted(b.keys() - a.keys()), sorted(a.keys() - b.keys())
    other = [name for name in a.keys() & b.keys() if a[name] != b[name]]
    assert not (missing or extra or other), f"{how}: missing {missing}, extra {extra}, other {other}"
    print(f"{how}: {len(a)} files, the same as by study run", flush=True)


def finished_cells(folder):
    return sum(1 for p in folder.glob("cells/*/run/run.json")
               if json.loads(p.read_text())["status"] in ("finished", "not-converged"))


def wait_until(there, what, seconds=60):
    end = time.monotonic() + seconds
    while not there():
        assert time.monotonic() < end, f"{what} in {seconds} s"
        time.sleep(0.05)


class Slurm:
    """One node, while it lives."""

    def __init__(self, folder):
        assert os.geteuid() == 0, "a Slurm of one's own needs root"
        self.folder = folder
        self.processes = []
        for name in ("state", "spool"):
            (folder / name).mkdir()
        folder.chmod(0o755)
        host = socket.gethostname().split(".")[0]
        config = folder / "slurm.conf"
        config.write_text(SLURM.format(host=host, folder=folder, cores=os.cpu_count(), controller_port=free_port(),
                                       node_port=free_port()))
        self.environment = {**os.environ, "SLURM_CONF": str(config)}
        try:
            self.start_munge()
            self.start("slurmctld", "-D", "-c")
            self.start("slurmd", "-D", "-N", host)
            wait_until(self.idle, "the node is ready")
        except BaseException:
            self.stop()
            raise

    def start_munge(self):
        """A key and a daemon of our own: whatever the machine has is left alone."""
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        self.start("munged", "--foreground", "--force", f"--key-file={key}",
                   f"--socket={self.folder}/munge.socket", f"--pid-file={self.folder}/munge.pid",
                   f"--log-file={self.folder}/munge.log", f"--seed-file={self.folder}/munge.seed")
        wait_until((self.folder / "munge.socket").exists, "munge is ready")

    def start(self, program, *arguments):
        path = shutil.which(program, path="/usr/sbin:/usr/bin:/sbin:/bin")
        assert path, f"{program} isn't installed"
        log = open(self.folder / f"{program}.out", "wb")
        self.processes.append(subprocess.Popen([path, *arguments], env=self.environment, stdin=subprocess.DEVNULL,
                                               stdout=log, stderr=log, start_new_session=True))

    def idle(self):
        for process in self.processes:
            assert process.poll() is None, "".join(p.read_text(errors="replace")[-2000:]
                                                   for p in self.folder.glob("*.*") if p.suffix in (".out", ".log"))
        shown = subprocess.run(["sinfo", "-h", "-o", "%T"], env=self.environment, capture_output=True, text=True)
        return shown.stdout.strip() == "idle"

    def queued(self):
        shown = subprocess.run(["squeue", "-h"], env=self.environment, capture_output=True, text=True, check=True)
        return shown.stdout.strip()

    def stop(self):
        for process in reversed(self.processes):
            process.terminate()
        for process in reversed(self.processes):
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def test_snakemake(source, command, study, expected, scratch):
    snakemake = shutil.which("snakemake", path="/usr/bin:" + os.environ["PATH"])
    assert snakemake, "snakemake isn't installed"
    out = scratch / "by-snakemake"
    words = [snakemake, "-s", source / "apps/study/cluster/Snakefile", "--cores", "2", "--nolock",
             "--rerun-incomplete", "--directory", scratch, "--config", f"study={study}", f"out={out}",
             f"patchlight={command}"]
    environment = {**os.environ, "XDG_CACHE_HOME": str(scratch / "cache"), "HOME": str(scratch)}
    first = subprocess.Popen(words, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                             stderr=subprocess.PIPE, text=True, start_new_session=True)
    wait_until(lambda: finished_cells(out) >= 2 or first.poll() is not None, "two cells by Snakemake", 300)
    assert first.poll() is None, first.stderr.read()[-3000:]
    os.killpg(first.pid, signal.SIGKILL)
    first.wait()
    assert not (out / "study.json").exists(), "it ended before it was killed"
    again = subprocess.run(words, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    assert again.returncode == 0, again.stderr[-3000:]
    check_same(out, expected, "Snakemake, killed once")


def test_slurm(source, command, study, expected, scratch):
    slurm_folder = scratch / "slurm"
    slurm_folder.mkdir()
    out = scratch / "by-slurm"
    slurm = Slurm(slurm_folder)
    try:
        environment = {**slurm.environment, "PATCHLIGHT": str(command)}
        words = [source / "apps/study/cluster/slurm-study", study, out]
        subprocess.run(words, env=environment, cwd=scratch, check=True, stdout=subprocess.DEVNULL)
        wait_until(lambda: finished_cells(out) >= 2, "two cells by Slurm", 300)
        subprocess.run(["scancel", "--user=root"], env=environment, check=True)
        wait_until(lambda: not slurm.queued(), "an empty queue")
        assert not (out / "study.json").exists(), "it ended before it was cancelled"
        subprocess.run(words, env=environment, cwd=scratch, check=True, stdout=subprocess.DEVNULL)
        wait_until(lambda: not slurm.queued(), "the study's end", 300)
        logs = "".join(p.read_text(errors="replace") for p in scratch.glob("by-slurm.slurm-*.log"))
        assert (out / "study.json").exists(), logs[-3000:]
        check_same(out, expected, "Slurm, cancelled once")
    finally:
        slurm.stop()


def main():
    source, build = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    wanted = sys.argv[3:] or ["snakemake", "slurm"]
    command = build / "patchlight"
    with tempfile.TemporaryDirectory(prefix="patchlight-cluster-") as folder:
        scratch = Path(folder)
        scratch.chmod(0o755)
        study = scratch / "study.toml"
        study.write_text(STUDY.format(scene=source / "data/scenes/cornell-box.obj"))
        expected = scratch / "by-run"
        subprocess.run([command, "study", "run", study, "-o", expected, "--quiet"], check=True,
                       stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        for name in wanted:
            {"snakemake": test_snakemake, "slurm": test_slurm}[name](source, command, study, expected, scratch)


if __name__ == "__main__":
    main()
