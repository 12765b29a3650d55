"""Runs a page in headless Chromium: one server on this machine, one browser, many jobs; has three.js draw glTF files so."""

import http.server
import json
import shutil
import subprocess
import tempfile
import threading
from pathlib import Path
from urllib.parse import unquote

HERE = Path(__file__).resolve().parent
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
TYPES = {".html": "text/html", ".mjs": "text/javascript", ".js": "text/javascript", ".json": "application/json"}


class Failed(Exception):
    """The browser answered nothing."""


class Answers(http.server.BaseHTTPRequestHandler):
    """/jobs.json, /three/..., files/NUMBER/... below the folder of job NUMBER's file, and the files of the page's folder."""

    def do_GET(self):
        path = unquote(self.path.partition("?")[0])
        if path == "/jobs.json":
            return self.answer(json.dumps(self.server.jobs).encode(), ".json")
        if path.startswith("/three/"):
            folder, name = self.server.three, path[len("/three/"):]
        elif path.startswith("/files/"):
            number, _, name = path[len("/files/"):].partition("/")
            folder = self.server.files[int(number)].parent
        else:
            folder, name = self.server.folder, path[1:]
        file = (folder / name).resolve()
        if not file.is_relative_to(folder.resolve()) or not file.is_file():
            return self.send_error(404)
        return self.answer(file.read_bytes(), file.suffix)

    def answer(self, data, suffix):
        self.send_response(200)
        self.send_header("Content-Type", TYPES.get(suffix, "application/octet-stream"))
        self.send_header("Content-Length", str(len(data)))
        self.end_headers()
        self.wfile.write(data)

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        kind, _, number = self.path[1:].partition("/")
        if kind == "result":
            self.server.results[int(number)] = body
        elif kind == "failed":
            self.server.problems.append(f"{number}: {body.decode(errors='replace')}")
        self.answer(b"", "")
        if kind == "done":
            self.server.is_done.set()

    def log_message(self, *_):
        pass


def draw(jobs, three, seconds=400):
    """The pictures of jobs, each {"file", "width", "height", "yaw", "pitch", "distance", "background"} and perhaps {"clip", "time"},
    as read_png gives them; None for one that three.js could not draw, with the reason in the list that comes with them.
    three: the folder of the package."""
    files = [Path(job["file"]).resolve() for job in jobs]
    sent = [{**{key: value for key, value in job.items() if key != "file"}, "url": f"files/{number}/{file.name}"}
            for number, (job, file) in enumerate(zip(jobs, files))]
    pictures, problems, console = run_page(HERE, sent, seconds, three=three, files=files)
    return [upright(pictures.get(number), job) for number, job in enumerate(jobs)], problems, console


def run_page(folder, jobs, seconds, *, three=None, files=(), flags=()):
    """Opens page.html of a folder, which fetches /jobs.json and posts /result/NUMBER, /failed/NUMBER and, at the end, /done. Returns
    the results by number, the failures, and the lines of the console. Raises Failed if there is no result."""
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Answers)
    server.daemon_threads = True
    server.folder, server.jobs, server.three, server.files = folder, jobs, three, files
    server.results, server.problems = {}, []
    server.is_done = threading.Event()
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    profile = tempfile.mkdtemp(prefix="bendy-page-")
    with open(Path(profile) / "log", "wb") as log:
        browser = subprocess.Popen(
            [CHROMIUM, "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--disable-quic", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-proxy-server",
             "--enable-logging=stderr", *flags, f"--user-data-dir={profile}",
             f"http://127.0.0.1:{server.server_address[1]}/page.html"],
            stdout=subprocess.DEVNULL, stderr=log)
        try:
            if not server.is_done.wait(seconds):
                server.problems.append("all: the browser did not come to an end")
        finally:
            browser.terminate()
            try:
                browser.wait(20)
            except subprocess.TimeoutExpired:
                browser.kill()
                browser.wait()
            server.shutdown()
            server.server_close()
    console = [line for line in (Path(profile) / "log").read_text(errors="replace").splitlines() if "CONSOLE" in line]
    shutil.rmtree(profile, ignore_errors=True)
    if not server.results:
        raise Failed("\n".join(server.problems + console))
    return server.results, server.problems, console


def upright(pixels, job):
    """WebGL begins at the bottom and has alpha."""
    if pixels is None:
        return None
    width, height = job["width"], job["height"]
    rows = [pixels[4 * width * y:4 * width * (y + 1)] for y in range(height - 1, -1, -1)]
    rgb = bytearray(3 * width * height)
    joined = b"".join(rows)
    for channel in range(3):
        rgb[channel::3] = joined[channel::4]
    return width, height, 3, bytes(rgb)
