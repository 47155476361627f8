#!/usr/bin/env python3
"""Renders a volume of 1024 x 1024 x 1024 u16 (2 GiB of voxels) from several formats and prints JSON: seconds, and the
peak resident memory of voxlume and its reader together, mapped file pages included, over the bytes of the voxels.

    bench/large.py [FORMAT...]     of raw nrrd nhdr mhd unaligned nii nrrd.gz nii.gz; all when none is named

VOXLUME names the program, SIZE the edge [voxels], FOLDER where the files go (twice the voxels; removed at the end).
"""
import array
import gzip
import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import time

TOP = pathlib.Path(__file__).resolve().parent.parent
VOXLUME = os.environ.get("VOXLUME", str(TOP / "build/release/voxlume"))
SIZE = int(os.environ.get("SIZE", "1024"))
SPACING = 240 / SIZE
FORMATS = ["raw", "nrrd", "nhdr", "mhd", "unaligned", "nii", "nrrd.gz", "nii.gz"]
SPACE = f"space: left-posterior-superior\nspace directions: ({SPACING},0,0) (0,{-SPACING},0) (0,0,{SPACING})\n"


def head_ct():
    """The sample head as (sizes, rows of HU + 1024)."""
    text = (TOP / "data/head-ct.nrrd").read_bytes()
    start = text.index(b"\n\n") + 2
    sizes = next(line for line in text[:start].decode().splitlines() if line.startswith("sizes:"))
    size = [int(n) for n in sizes.split()[1:]]
    values = array.array("h", text[start:])
    return size, [array.array("H", (max(v + 1024, 0) for v in values[at:at + size[0]]))
                  for at in range(0, len(values), size[0])]


def write_voxels(path):
    """The head enlarged: linear along rows, nearest across them, with one voxel changed in each."""
    size, rows = head_ct()
    places = [i * (size[0] - 1) / (SIZE - 1) for i in range(SIZE)]
    pairs = [(int(p), min(int(p) + 1, size[0] - 1), p - int(p)) for p in places]
    with open(path, "wb") as out:
        made = {}
        for k in range(SIZE):
            slice_k = k * size[2] // SIZE
            if slice_k not in made:
                made = {slice_k: [array.array("H", (int(row[a] + f * (row[b] - row[a])) for a, b, f in pairs))
                                  for row in rows[slice_k * size[1]:(slice_k + 1) * size[1]]]}
            for j in range(SIZE):
                row = made[slice_k][j * size[1] // SIZE]
                at = (j * 7 + k * 3) % SIZE
                row[at] ^= 1
                row.tofile(out)


def nrrd_header(encoding, more=""):
    return (f"NRRD0004\ntype: uint16\ndimension: 3\n{SPACE}sizes: {SIZE} {SIZE} {SIZE}\nendian: little\n"
            f"encoding: {encoding}\n{more}\n").encode()


def of_parity(header, odd):
    """The header, with a comment more if its length is not odd or even as wished."""
    return header if len(header) % 2 == odd else header[:-1] + b"# \n\n"


def nifti_header():
    h = bytearray(352)
    struct.pack_into("<i", h, 0, 348)
    struct.pack_into("<8h", h, 40, 3, SIZE, SIZE, SIZE, 1, 1, 1, 1)
    struct.pack_into("<hh", h, 70, 512, 16)
    struct.pack_into("<8f", h, 76, 1, SPACING, SPACING, SPACING, 0, 0, 0, 0)
    struct.pack_into("<f", h, 108, 352)
    h[344:348] = b"n+1\0"
    return bytes(h)


def write_file(kind, folder, voxels):
    """Writes the file of one format; returns it and the flags it needs."""
    def with_voxels(name, header, compressed=False):
        with open(folder / name, "wb") as out, open(voxels, "rb") as data:
            if compressed == "all":
                out = gzip.GzipFile(fileobj=out, mode="wb", compresslevel=1)
            out.write(header)
            if compressed == "voxels":
                out = gzip.GzipFile(fileobj=out, mode="wb", compresslevel=1)
            shutil.copyfileobj(data, out, 1 << 22)
            if compressed:
                out.close()
        return folder / name, []

    if kind == "raw":
        return voxels, ["--raw", f"{SIZE}x{SIZE}x{SIZE},u16,{SPACING},{SPACING},{SPACING}"]
    if kind == "nhdr":
        (folder / "a.nhdr").write_bytes(nrrd_header("raw", f"data file: {voxels.name}\n"))
        return folder / "a.nhdr", []
    if kind == "mhd":
        (folder / "a.mhd").write_text(
            f"ObjectType = Image\nNDims = 3\nDimSize = {SIZE} {SIZE} {SIZE}\nElementType = MET_USHORT\nElementSpacing = "
            f"{SPACING} {SPACING} {SPACING}\nBinaryDataByteOrderMSB = False\nElementDataFile = {voxels.name}\n")
        return folder / "a.mhd", []
    if kind == "nrrd":
        return with_voxels("a.nrrd", of_parity(nrrd_header("raw"), odd=False))
    if kind == "unaligned":
        return with_voxels("b.nrrd", of_parity(nrrd_header("raw"), odd=True))
    if kind == "nii":
        return with_voxels("a.nii", nifti_header())
    if kind == "nrrd.gz":
        return with_voxels("c.nrrd", nrrd_header("gzip"), "voxels")
    return with_voxels("a.nii.gz", nifti_header(), "all")


def resident_bytes(pid):
    """Resident bytes of a process and its children, pages they share counted for each."""
    total = 0
    try:
        with open(f"/proc/{pid}/statm") as file:
            total = int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE")
        for task in os.listdir(f"/proc/{pid}/task"):
            with open(f"/proc/{pid}/task/{task}/children") as file:
                total += sum(resident_bytes(child) for child in file.read().split())
    except (FileNotFoundError, ProcessLookupError):
        pass
    return total


def run(arguments):
    start = time.monotonic()
    process = subprocess.Popen(arguments, stdout=subprocess.DEVNULL)
    peak = 0  # sampled: memory grows over seconds
    while process.poll() is None:
        peak = max(peak, resident_bytes(process.pid))
        time.sleep(0.005)
    if process.returncode:
        sys.exit(f"{' '.join(map(str, arguments))}: exit code {process.returncode}")
    return time.monotonic() - start, peak


def measure(kind, folder, voxels):
    path, flags = write_file(kind, folder, voxels)
    picture, stats = folder / "a.png", folder / "stats.json"
    seconds, peak = run([VOXLUME, "render", path, *flags, "--size", "256x256", "--spp", "4", "--stats", stats,
                         "-o", picture])
    if path != voxels:
        path.unlink()
    return {"format": kind, "peak_bytes": peak, "peak_over_voxels": round(peak / (2 * SIZE**3), 4),
            "load_s": round(json.loads(stats.read_text())["load_s"], 2), "total_s": round(seconds, 2)}


def main():
    kinds = sys.argv[1:] or FORMATS
    folder = pathlib.Path(tempfile.mkdtemp(prefix="voxlume-large-", dir=os.environ.get("FOLDER")))
    try:
        voxels = folder / "voxels.raw"
        write_voxels(voxels)
        results = []
        for kind in kinds:
            results.append(measure(kind, folder, voxels))
            print(json.dumps(results[-1]), file=sys.stderr)
        print(json.dumps({"voxels": [SIZE] * 3, "type": "u16", "voxel_bytes": 2 * SIZE**3, "runs": results},
                         indent=1))
    finally:
        shutil.rmtree(folder)


main()
