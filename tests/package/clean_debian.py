"""A clean Debian 12 in a folder, and programs in it."""
import os
import pathlib
import re
import shutil

from packages import BUILD, run, skip

MOUNTS = ('mount -t proc proc "$0/proc"; mount -t tmpfs tmpfs "$0/dev/shm"; mount -t devpts -o newinstance,ptmxmode=0666,mode=0620,gid=5 '
          'devpts "$0/dev/pts"; rm -f "$0/dev/ptmx"; ln -s pts/ptmx "$0/dev/ptmx"; exec chroot "$0" "$@"')


def mirror():
    """The mirror that this machine's own apt uses for Debian 12; none: debootstrap's."""
    told = run("apt-get", "indextargets", "--format", "$(RELEASE) $(COMPONENT) $(SITE)", "Created-By: Packages", check=False).stdout
    return [line.split()[2] for line in told.splitlines() if line.startswith("bookworm main ")][:1]


def make(target):
    """A minimal Debian 12; kept as an archive in the build's folder."""
    kept = BUILD / "test-artifacts/bookworm-minbase.tar"
    target.mkdir(parents=True)
    if not kept.exists():
        kept.parent.mkdir(parents=True, exist_ok=True)
        done = run("debootstrap", "--variant=minbase", "bookworm", target, *mirror(), check=False, timeout=900)
        if done.returncode != 0:
            if re.search(r"Failed getting release file|Couldn't (retrieve|download)|Couldn't resolve|unreachable", done.stdout + done.stderr):
                skip("no mirror of Debian can be reached")
            raise AssertionError(done.stdout[-3000:] + done.stderr[-3000:])
        run("tar", "--numeric-owner", "--exclude=./dev/*", "--exclude=./var/cache/apt/archives/*.deb", "-C", target, "-cf",
            f"{kept}.part", ".")
        os.rename(f"{kept}.part", kept)
    else:
        run("tar", "--numeric-owner", "-C", target, "-xpf", kept)
    for name in ("shm", "pts"):
        (target / "dev" / name).mkdir(exist_ok=True)
    for name, minor in (("null", 3), ("zero", 5), ("urandom", 9)):
        if not (target / "dev" / name).exists():
            os.mknod(target / "dev" / name, 0o020666, os.makedev(1, minor))
        os.chmod(target / "dev" / name, 0o666)
    (target / "etc/apt/sources.list").unlink(missing_ok=True)
    for part in ("sources.list", "sources.list.d", "apt.conf", "apt.conf.d", "preferences", "preferences.d", "trusted.gpg.d", "keyrings"):
        if pathlib.Path("/etc/apt", part).exists():
            run("cp", "-a", f"/etc/apt/{part}", target / "etc/apt/")
    for name in ("resolv.conf", "hosts"):
        shutil.copy(pathlib.Path("/etc", name).resolve(), target / "etc" / name)


def inside(target, *words, check=True):
    """Runs a command in it; its mounts are gone with it."""
    environment = {key: value for key, value in os.environ.items() if key.endswith("_proxy")}
    environment.update(PATH="/usr/sbin:/usr/bin:/sbin:/bin", LC_ALL="C.UTF-8", DEBIAN_FRONTEND="noninteractive", HOME="/root")
    return run("unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-e", "-c", MOUNTS, target, *words, check=check,
               env=environment, timeout=900)


def add_packages(target, packages, *others):
    """Copies packages into it and has apt install them, and others by name."""
    (target / "packages").mkdir(exist_ok=True)
    for path in packages:
        shutil.copy(path, target / "packages")
    names = " ".join(others)
    inside(target, "sh", "-c", f"apt-get install -q -y --no-install-recommends {names} /packages/*.deb")
