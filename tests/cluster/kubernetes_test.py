#!/usr/bin/env python3
"""The manifests of `--engine kubernetes`: what a parser of YAML reads, what the published types allow, and what a container's
script does. No Kubernetes runs here, so none has ever run them.
"""
import copy
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import campaign_rig

try:
    import yaml
except ImportError:
    campaign_rig.skip("there is no parser of YAML: apt-get install python3-yaml")

HERE = pathlib.Path(__file__).resolve().parent
# Nothing of these texts may be read as anything by YAML, by Kubernetes or by a shell.
ODD_NAME = "it's \"$(HOME)\": #1 \\n {a} ü"
# Stands for the program in a container: tells its words, and ends as it is told to.
PROGRAM = """\
#!/bin/sh
printf '%s\\n' "$@" >"$WORDS"
trap 'echo asked >>"$WORDS"; exit 75' TERM
[ -z "${WAITS:-}" ] || while :; do sleep 0.05; done
exit "${CODE:-0}"
"""


def manifests(folder):
    """Both, as Kubernetes would read them, with the scenario and the results they are for."""
    scenario, out = folder / f"{ODD_NAME}.toml", folder / f"out {ODD_NAME}"
    scenario.write_text(campaign_rig.SCENARIO)
    done = campaign_rig.run(scenario, out, 40, "--engine", "kubernetes", "--shards", 8, "--image", "registry.example/skyloop:1.0",
                            "--claim", "results", "--mount", folder, "--namespace", "lab", "--parallelism", 5)
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    read = [yaml.safe_load((out / "kubernetes" / name).read_text(encoding="utf-8")) for name in ("campaign.yaml", "gather.yaml")]
    return scenario, out, *read


def command_of(job):
    """A container's words, after Kubernetes' own replacements."""
    container = job["spec"]["template"]["spec"]["containers"][0]
    return [word.replace("$$", "$") for word in container["command"] + container["args"]]


class Manifests(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="skyloop-kubernetes-")
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.scenario, self.out, self.shards, self.gather = manifests(self.root)

    def test_a_parser_reads_what_was_meant(self):
        spec = self.shards["spec"]
        self.assertEqual((self.shards["apiVersion"], self.shards["kind"]), ("batch/v1", "Job"))
        self.assertEqual(self.shards["metadata"]["namespace"], "lab")
        self.assertEqual(
            {key: spec[key] for key in ("completionMode", "completions", "parallelism", "backoffLimitPerIndex",
                                        "podReplacementPolicy")},
            {"completionMode": "Indexed", "completions": 8, "parallelism": 5, "backoffLimitPerIndex": 3,
             "podReplacementPolicy": "Failed"})
        rules = spec["podFailurePolicy"]["rules"]
        self.assertEqual([rule["action"] for rule in rules], ["Ignore", "FailJob"])
        self.assertEqual(rules[0]["onPodConditions"], [{"type": "DisruptionTarget", "status": "True"}])
        pod = spec["template"]["spec"]
        self.assertEqual(rules[1]["onExitCodes"],
                         {"containerName": pod["containers"][0]["name"], "operator": "In", "values": [2]})
        self.assertEqual(pod["restartPolicy"], "Never")
        writer = {"runAsUser": os.geteuid(), "runAsGroup": os.getegid(), "fsGroup": os.getegid(),
                  "fsGroupChangePolicy": "OnRootMismatch"}
        for job in (self.shards, self.gather):
            self.assertEqual(job["spec"]["template"]["spec"].get("securityContext"), writer if os.geteuid() else None)
        self.assertEqual(pod["volumes"][0]["persistentVolumeClaim"]["claimName"], "results")
        self.assertEqual(pod["containers"][0]["volumeMounts"][0]["mountPath"], str(self.root))
        words = command_of(self.shards)
        self.assertEqual(words[:2], ["/bin/sh", "-c"])
        self.assertEqual(words[3:], ["shard", "skyloop", "campaign", str(self.scenario), "--seeds", "40", "--out", str(self.out)])
        self.assertEqual(command_of(self.gather)[3:], ["shard", "skyloop", "campaign", "gather", str(self.out)])

    def run_container(self, job, waits=False, **environment):
        """The container's command here, with a program that stands for skyloop; gives the process."""
        program = self.root / "bin/skyloop"
        program.parent.mkdir(exist_ok=True)
        program.write_text(PROGRAM)
        program.chmod(0o755)
        self.words = self.root / "words"
        self.words.unlink(missing_ok=True)
        return subprocess.Popen(command_of(job), stdin=subprocess.DEVNULL, env={
            **os.environ, **environment, "PATH": f"{program.parent}:{os.environ['PATH']}", "WORDS": str(self.words),
            "JOB_COMPLETION_INDEX": "6", **({"WAITS": "yes"} if waits else {})})

    def test_exit_codes_mean_to_kubernetes_what_they_are(self):
        for code, seen in (("0", 0), ("2", 2), ("3", 0), ("75", 75), ("1", 1)):
            for job in (self.shards, self.gather):
                self.assertEqual(self.run_container(job, CODE=code).wait(timeout=20), seen)
        self.run_container(self.shards).wait(timeout=20)
        self.assertEqual(self.words.read_text().splitlines(),
                         ["campaign", str(self.scenario), "--seeds", "40", "--out", str(self.out), "--jobs", "1", "--shard", "6/8"])

    def test_a_container_that_must_go_asks_the_program_to(self):
        process = self.run_container(self.shards, waits=True)
        try:
            end = time.monotonic() + 20
            while not (self.words.exists() and "6/8" in self.words.read_text()):
                self.assertLess(time.monotonic(), end)
                time.sleep(0.02)
            time.sleep(0.1)  # until its trap is set
            process.send_signal(signal.SIGTERM)
            self.assertEqual(process.wait(timeout=20), 75)
        finally:
            process.kill()
            process.wait(timeout=20)
        self.assertEqual(self.words.read_text().splitlines()[-1], "asked")

    def test_the_published_types_have_all_of_it(self):
        folder = self.types()
        for job in (self.shards, self.gather):
            self.assertEqual(self.complaints(folder, job), "")
        # And would say so if not.
        for spoil, told in ((lambda job: job["spec"].update(completion=3), "JobSpec has no field completion"),
                            (lambda job: job["spec"].update(completions="x"), "must be integer"),
                            (lambda job: job["spec"]["template"]["spec"]["containers"][0].pop("name"), "required property name")):
            job = copy.deepcopy(self.shards)
            spoil(job)
            self.assertIn(told, self.complaints(folder, job))

    def types(self):
        """A folder with kubernetes-models, installed once; skips where that cannot be."""
        if not shutil.which("node") or not shutil.which("npm"):
            self.skipTest("there is no node or npm; apt-get install nodejs npm")
        folder = pathlib.Path(os.environ.get("SKYLOOP_NODE_FOLDER", self.root / "types"))
        folder.mkdir(parents=True, exist_ok=True)
        if not (folder / "node_modules/kubernetes-models").exists():
            shutil.copy(HERE / "package.json", folder)
            done = subprocess.run(["npm", "install", "--prefer-offline", "--no-audit", "--no-fund", "--no-package-lock"], cwd=folder,
                                  capture_output=True, text=True, timeout=180, check=False)
            if done.returncode != 0:
                self.skipTest(f"npm cannot install kubernetes-models: {done.stderr.splitlines()[-1:]}")
        return folder

    def complaints(self, folder, job):
        done = subprocess.run(["node", HERE / "check_job.mjs", folder], input=json.dumps(job), capture_output=True, text=True,
                              timeout=60, check=False)
        self.assertEqual(done.stderr, "")
        self.assertEqual(done.returncode, 1 if done.stdout else 0)
        return done.stdout


if __name__ == "__main__":
    unittest.main(verbosity=2)
