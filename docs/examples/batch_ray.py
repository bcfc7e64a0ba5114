"""Runs a batch of Toile on a Ray cluster: pip install ray, then batch_ray.py SPEC.json DIR.

DIR lies on a disk that all machines share, and toile is on their PATH. On one machine set RAY_AUTH_MODE=disabled
(done here), else Ray writes a token into the home folder. Killed or stopped, run it again: what is done stays done.
"""
import json, os, subprocess, sys

os.environ.setdefault("RAY_AUTH_MODE", "disabled")
import ray


@ray.remote(num_cpus=1, max_retries=3)
def do(job):
    # The pipe closes when this process ends, and with it ends the job.
    child = subprocess.Popen(["toile", "job", job], stdin=subprocess.PIPE, stderr=subprocess.PIPE)
    words = child.stderr.read().decode(errors="replace")
    child.wait()
    if not os.path.exists(os.path.join(os.path.dirname(job), "result.json")):
        raise RuntimeError(words)  # A job that failed has a result; without one it was not done.


spec, folder = sys.argv[1:]
batch = ["toile", "batch", spec, "--out", folder]
jobs = json.loads(subprocess.run(batch + ["--list", "--json"], check=True, stdout=subprocess.PIPE).stdout)["jobs"]
ray.init(address=os.environ.get("RAY_ADDRESS"))
waiting = [do.remote(job["job"]) for job in jobs if job["state"] == "waiting"]
while waiting:
    done, waiting = ray.wait(waiting)
    ray.get(done)
    print(len(waiting), "jobs left", flush=True)
sys.exit(subprocess.run(batch + ["--report"]).returncode)
