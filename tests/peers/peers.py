"""Peers on the meshes that the command line writes: one linear fair solve, one remeshing, and what their triangles are like.

    python -m venv target/peers && target/peers/bin/pip install -r tests/peers/requirements.txt
    (cd tests/peers/npm && npm ci)
    target/peers/bin/python tests/peers/peers.py [--ductile PATH]

The peers in Rust and our own code beside them are a program of their own (`rust`, built by cargo when it is needed), the one
from npm is called by `npm/manifold.mjs`. `--only rust` leaves the others out and needs no virtual environment.

Each peer runs in a process of its own with a time limit, so that one that crashes or hangs is a line in the table and nothing
more. The linear solve is biharmonic, with the boundary and one inner node held; ours is the non-linear one, to rest and with the
mesh improved on the way, so it is given for orientation only. The other meshes are those of our benches, written by `rust`, with ours
timed beside them: the uneven torus of figure e, the even one of figure f, and the tube of 96,000 nodes of figure b.
"""

import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import time

try:
    import numpy as np
except ImportError:  # the peers in Rust and from npm need none
    np = None

HERE = pathlib.Path(__file__).resolve().parent
TOP = HERE.parent.parent
LIMIT = 120  # seconds that a peer may take
REPEATS = 5  # of a timing, of which the median is given


def read_obj(path):
    vertices, faces = [], []
    for line in pathlib.Path(path).read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            faces.append([int(word.split("/")[0]) - 1 for word in words[1:4]])
    return np.array(vertices), np.array(faces, dtype=np.int64)


def write_obj(path, vertices, faces):
    lines = ["v %r %r %r" % tuple(map(float, v)) for v in vertices] + ["f %d %d %d" % tuple(f + 1) for f in faces]
    pathlib.Path(path).write_text("\n".join(lines) + "\n")


def edges(faces):
    """Every edge once, and how many faces it has."""
    sides = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    return np.unique(sides, axis=0, return_counts=True)


def boundary(faces):
    found, counts = edges(faces)
    return np.unique(found[counts == 1])


def quality(vertices, faces):
    """Angles in degrees, the share of inner nodes with degree 6, and the spread of the edges."""
    corners = vertices[faces]
    angles = []
    for k in range(3):
        a, b = corners[:, (k + 1) % 3] - corners[:, k], corners[:, (k + 2) % 3] - corners[:, k]
        angles.append(np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), np.sum(a * b, axis=1))))
    least = np.min(angles, axis=0)
    found, _ = edges(faces)
    lengths = np.linalg.norm(vertices[found[:, 0]] - vertices[found[:, 1]], axis=1)
    degree = np.bincount(found.ravel(), minlength=len(vertices))
    inner = np.ones(len(vertices), dtype=bool)
    inner[boundary(faces)] = False
    inner &= degree > 0
    return {
        "nodes": int(np.count_nonzero(degree)),
        "least angle": float(least.min()),
        "1 % angle": float(np.percentile(least, 1)),
        "mean least": float(least.mean()),
        "degree 6": float(np.mean(degree[inner] == 6)),
        "edge max/mean": float(lengths.max() / lengths.mean()),
    }


def held(path, vertices, faces):
    """The nodes that a file beside the mesh names, or else boundary and highest node; and where they are."""
    named = pathlib.Path(path).with_suffix(".held")
    if named.exists():
        nodes = np.array(named.read_text().split(), dtype=np.int64)
    else:
        nodes = np.append(boundary(faces), np.argmax(vertices[:, 2])).astype(np.int64)
    return nodes, vertices[nodes]


def solve_igl(vertices, faces, path, _):
    import igl

    nodes, places = held(path, vertices, faces)
    return lambda: igl.harmonic(vertices, faces, nodes, np.ascontiguousarray(places), 2)


def solve_gpytoolbox(vertices, faces, path, _):
    import gpytoolbox

    nodes, places = held(path, vertices, faces)

    def solve():
        energy = gpytoolbox.biharmonic_energy(vertices, faces, bc="mixedfem_zero_neumann")
        return gpytoolbox.min_quad_with_fixed(energy, k=nodes, y=places)

    return solve


def solve_scipy(vertices, faces, path, _):
    import igl
    from scipy.sparse import diags
    from scipy.sparse.linalg import splu

    nodes, places = held(path, vertices, faces)
    free = np.setdiff1d(np.arange(len(vertices)), nodes)

    def solve():
        stiffness = igl.cotmatrix(vertices, faces)
        mass = igl.massmatrix(vertices, faces, igl.MASSMATRIX_TYPE_VORONOI)
        matrix = (stiffness @ diags(1 / mass.diagonal()) @ stiffness).tocsc()
        right = -matrix[free][:, nodes] @ places
        inner = matrix[free][:, free].tocsc()
        symmetric = {"SymmetricMode": True}
        return splu(inner, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=symmetric).solve(right)

    return solve


ROUNDS = 10  # of a remeshing from scratch; a batch is one


def remesh_pymeshlab(vertices, faces, _, length, rounds=ROUNDS):
    import pymeshlab

    def remesh():
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
        meshes.meshing_isotropic_explicit_remeshing(iterations=rounds, targetlen=pymeshlab.PureValue(length))
        return meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix().astype(np.int64)

    return remesh


def remesh_gpytoolbox(vertices, faces, _, length, rounds=ROUNDS):
    import gpytoolbox

    return lambda: gpytoolbox.remesh_botsch(vertices, faces.astype(np.int32), i=rounds, h=length)


def remesh_cgal(vertices, faces, _, length, rounds=ROUNDS):
    from compas_cgal.meshing import trimesh_remesh

    return lambda: trimesh_remesh((vertices, faces.astype(np.int32)), length, rounds)


def once(remesh):
    return lambda *given: remesh(*given, rounds=1)


REMESHERS = {"pymeshlab": remesh_pymeshlab, "gpytoolbox remesh_botsch": remesh_gpytoolbox, "compas_cgal": remesh_cgal}
WORK = {
    "solve": {"igl harmonic, k = 2": solve_igl, "igl matrices, scipy splu": solve_scipy, "gpytoolbox": solve_gpytoolbox},
    "remesh": REMESHERS,
    "batch": {name: once(remesh) for name, remesh in REMESHERS.items()},
}


def one(kind, name, path, length):
    """The work of one peer, in its own process: prints its figures as JSON."""
    vertices, faces = read_obj(path)
    work = WORK[kind][name](vertices, faces, path, float(length))
    seconds = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        found = work()
        seconds.append(time.perf_counter() - start)
    figures = {"seconds": float(np.median(seconds))}
    if kind != "solve":
        new_vertices, new_faces = np.asarray(found[0], dtype=float), np.asarray(found[1], dtype=np.int64)
        figures |= quality(new_vertices, new_faces)
        figures["finite"] = bool(np.isfinite(new_vertices).all())
    else:
        figures["finite"] = bool(np.isfinite(np.asarray(found)).all())
    print(json.dumps(figures))


def run(kind, name, path, length=0.0):
    command = [sys.executable, __file__, "--one", kind, name, str(path), str(length)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        return f"no answer in {LIMIT} s"
    if done.returncode < 0:
        return f"ended by signal {-done.returncode}"
    if done.returncode > 0:
        return (done.stderr.strip().splitlines() or ["failed without a word"])[-1][:80]
    figures = json.loads(done.stdout.splitlines()[-1])
    return figures if figures.pop("finite") else "the result is not finite"


QUALITY = ["nodes", "least angle", "1 % angle", "mean least", "degree 6", "edge max/mean"]


def line(name, figures):
    if isinstance(figures, str):
        return f"| {name} | {figures} |" + " |" * len(QUALITY)
    seconds = f"{figures['seconds']:.3f} s" if "seconds" in figures else ""
    cells = [f"{figures[key]:.3g}" if key != "nodes" else str(figures[key]) for key in QUALITY if key in figures]
    return f"| {name} | {seconds} | " + " | ".join(cells) + " |"


def ductile(program, spec, out):
    command = [program] if program else ["cargo", "run", "--release", "--quiet", "-p", "ductile-cli", "--"]
    done = subprocess.run(
        [*command, "solve", str(spec), "-o", str(out), "--report", "json"], capture_output=True, text=True, cwd=TOP
    )
    if done.returncode != 0:
        sys.exit(f"ductile could not write the mesh: {done.stderr.strip()}")
    return json.loads(done.stdout)


SPACINGS = [0.072, 0.024, 0.0172]  # of about 1,000, 10,000 and 15,000 nodes; while it grows, a model may have 20,000
MOVED = 0.37  # how far the torus is moved to meet itself


def built():
    """The program of the peers in Rust."""
    target = TOP / "target" / "peers-rust"
    build = ["cargo", "build", "--quiet", "--release", "--locked", "--target-dir", str(target)]
    subprocess.run(build, check=True, cwd=HERE / "rust")
    return target / "release" / "ductile-peers"


def told(*command):
    return subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout


def beside(program, folder):
    """The peers in Rust and from npm, and ours beside them; each prints lines of a table."""
    peers = built()
    ring = pathlib.Path(folder, "uneven.obj")
    print("\nFactoring and solving the plate of the raised disc, and our steps on it:\n\n| mesh | what | time |\n| --- | --- | --- |")
    for spacing in SPACINGS:
        spec, disc = pathlib.Path(folder, "disc.ductile.json"), pathlib.Path(folder, "disc.obj")
        spec.write_text(json.dumps(json.loads((HERE / "disc.ductile.json").read_text()) | {"spacing": spacing}))
        ductile(program, spec, disc)
        sys.stdout.flush()
        subprocess.run([peers, "plate", disc], check=True)
    print("\nThe uneven torus of 400 x 25:\n\n| what | time | result |\n| --- | --- | --- |", flush=True)
    subprocess.run([peers, "remesh"], check=True)
    told(peers, "torus", ring)
    subprocess.run([peers, "meet", ring, str(MOVED)], check=True)
    done = subprocess.run(["node", "manifold.mjs", str(ring), str(MOVED)], cwd=HERE / "npm")
    if done.returncode != 0:
        print("| manifold-3d | did not run | |")


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--ductile", help="the program, if it is built already")
    arguments.add_argument("--one", nargs=4, help=argparse.SUPPRESS)
    arguments.add_argument("--only", choices=["python", "rust"], help="leave the other peers out")
    options = arguments.parse_args()
    if options.one:
        return one(*options.one)
    if options.only != "python":
        print(f"load at the start: {os.getloadavg()[0]:.1f}")
        with tempfile.TemporaryDirectory() as folder:
            beside(options.ductile, folder)
    if options.only == "rust":
        return
    if np is None:
        sys.exit("the peers from Python need the virtual environment")
    with tempfile.TemporaryDirectory() as folder:
        python(options.ductile, pathlib.Path(folder))


def ratio(ours, figures):
    return "" if isinstance(figures, str) else f"{ours / figures['seconds']:.3f}"


def python(program, folder):
    """The peers from Python on meshes of ours, each with what ours takes on the same mesh in the same minutes."""
    disc, ring, even, tube = [folder / name for name in ["disc.obj", "torus.obj", "even.obj", "tube.obj"]]
    peers = built()
    report = ductile(program, HERE / "disc.ductile.json", disc)
    length = float(told(peers, "torus", ring))
    print(f"load at the start: {os.getloadavg()[0]:.1f}\n")
    shape = quality(*read_obj(disc))
    steps = [float(row.split("|")[3].split()[0]) / 1e3 for row in told(peers, "plate", disc).splitlines() if "one non" in row or "a frame" in row]
    frames = json.loads(told(peers, "tube", tube, tube.with_suffix(".held")))
    for title, mesh, ours in [
        (f"Raised disc of {shape['nodes']} nodes", disc, {"a step": steps[0], "a frame, predictor and step": steps[1]}),
        (f"Tube of 96,240 nodes, {frames['asleep']} of them asleep later", tube, {"the first frame": frames["first"], "a later frame": frames["later"]}),
    ]:
        print(f"\n{title}, one linear biharmonic solve (median of {REPEATS}; ours: least of 15):\n")
        print("| peer | time | " + " | ".join(f"{name} of ours : theirs" for name in ours) + " |\n" + "| --- " * (2 + len(ours)) + "|")
        for name in WORK["solve"]:
            figures = run("solve", name, mesh)
            time_of = figures if isinstance(figures, str) else "%.3f s" % figures["seconds"]
            print(f"| {name} | {time_of} | " + " | ".join(ratio(own, figures) for own in ours.values()) + " |", flush=True)
        for name, seconds in ours.items():
            print(f"| ductile: {name} | {seconds:.4f} s |" + " |" * len(ours))
    print(f"\nOpening the disc and bringing it to rest in {report['steps']} non-linear steps took {report['seconds']:.3f} s.")
    rows = [row for row in told(peers, "remesh").splitlines() if "ductile" in row]
    ours = float(rows[0].split("|")[2].split()[0]) / 1e3
    batch = json.loads(told(peers, "even", even))
    print("\nTriangles, and remeshing to our spacing: the uneven torus of 400 x 25 in ten rounds, then one round on the even one:\n")
    print("| mesh | time | " + " | ".join(QUALITY) + " | ours : theirs |\n" + "| --- " * (3 + len(QUALITY)) + "|")
    print(line("disc as ductile wrote it", shape) + " |")
    print(line("torus of 400 x 25 before", quality(*read_obj(ring))) + " |")
    for name in WORK["remesh"]:
        figures = run("remesh", name, ring, length)
        print(line(name, figures), ratio(ours, figures), "|", flush=True)
    print(rows[0])
    print(line("even torus, one vertex in 200 moved", quality(*read_obj(even))) + " |")
    for name in WORK["batch"]:
        figures = run("batch", name, even, length)
        print(line(name + ", one round", figures), ratio(batch["seconds"], figures), "|", flush=True)
    print(f"| ductile, one batch of {batch['edits']} edits | {batch['seconds']:.5f} s |" + " |" * (len(QUALITY) + 1))


if __name__ == "__main__":
    main()
