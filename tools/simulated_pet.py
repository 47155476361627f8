"""A PET scan as one might look of the brain of a label atlas, on a coarser grid: simulated_pet.py aal.nii.gz OUT.nrrd

Not a measurement: uptake by region (deep grey matter most, cerebellum least), one hot spot, blurred as a scanner
would. For examples of two modalities in one picture."""
import array
import gzip
import itertools
import struct
import sys

EDGE = 4  # atlas voxels to a side of one of the scan's
SPOT_MM, SPOT_RADIUS_MM = (34.0, -22.0, 52.0), 9.0  # right, anterior, superior


def uptake(label):
    if label == 0:
        return 0
    if 71 <= label <= 78:  # caudate, putamen, pallidum, thalamus
        return 1300
    return 600 if label >= 91 else 900  # cerebellum; the rest


def blur(values, size, axis):
    """Weights 1/4, 1/2, 1/4 along an axis."""
    stride = (1, size[0], size[0] * size[1])[axis]
    out = array.array("d", bytes(8 * len(values)))
    for i, value in enumerate(values):
        at = i // stride % size[axis]
        before = values[i - stride] if at > 0 else value
        after = values[i + stride] if at + 1 < size[axis] else value
        out[i] = 0.25 * before + 0.5 * value + 0.25 * after
    return out


with gzip.open(sys.argv[1]) as file:
    data = file.read()
dims = struct.unpack_from("<3h", data, 42)
datatype, = struct.unpack_from("<h", data, 70)
offset = int(struct.unpack_from("<f", data, 108)[0])
rows = [struct.unpack_from("<4f", data, 280 + 16 * r) for r in range(3)]
if datatype != 2 or struct.unpack_from("<h", data, 254)[0] == 0:
    sys.exit(f"{sys.argv[1]}: expected 8-bit labels and an sform")
labels = memoryview(data)[offset:]


def place(p):
    """mm to the right, anterior, superior of a place in atlas voxels."""
    return [sum(row[a] * p[a] for a in range(3)) + row[3] for row in rows]


size = [n // EDGE for n in dims]
scan = array.array("d")
for k, j, i in itertools.product(range(size[2]), range(size[1]), range(size[0])):
    total = 0.0
    for c in itertools.product((1, 2), repeat=3):
        x, y, z = EDGE * i + c[0], EDGE * j + c[1], EDGE * k + c[2]
        label = labels[x + dims[0] * (y + dims[1] * z)]
        off = [a - b for a, b in zip(place((x, y, z)), SPOT_MM)]
        total += 2600 if sum(o * o for o in off) < SPOT_RADIUS_MM**2 else uptake(label)
    scan.append(total / 8)
for axis in (0, 1, 2):
    scan = blur(scan, size, axis)

origin = place([(EDGE - 1) / 2] * 3)
directions = " ".join("(" + ",".join(f"{EDGE * row[a]:g}" for row in rows) + ")" for a in range(3))
with open(sys.argv[2], "wb") as out:
    out.write(("NRRD0004\ntype: uint16\ndimension: 3\nspace: right-anterior-superior\n"
               f"sizes: {size[0]} {size[1]} {size[2]}\nspace directions: {directions}\n"
               "kinds: domain domain domain\nendian: little\nencoding: raw\n"
               f"space origin: ({','.join(f'{o:g}' for o in origin)})\n\n").encode())
    voxels = array.array("H", (round(v) for v in scan))
    if sys.byteorder == "big":
        voxels.byteswap()
    out.write(voxels.tobytes())
