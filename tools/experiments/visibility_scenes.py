"""The scenes of the study of what hides the important: scene files as dictionaries."""
import copy
import pathlib

TOP = pathlib.Path(__file__).resolve().parents[2]
HALF_SIDE_MM = {"ct": 122.5, "mri": 108.5}  # half the longest side: the unit of the paper's step sizes
VOXEL_MM = {"ct": 0.957031, "mri": 1.0}     # smallest voxel side: the unit of march_step_voxels


def point(value, mu_t, color):
    return {"value": value, "mu_t_per_mm": mu_t, "color": color}


def sun(direction, intensity):
    return {"kind": "directional", "attached_to": "camera", "direction": direction, "intensity": intensity}


# Rays go through the middles of pixels, as those of lists do. Soft tissue like thick smoke, bone dense within it. All light is of lights without extent, so that marching has no noise.
CT = {
    "version": 1,
    "volume": {"path": str(TOP / "data/head-ct.nrrd")},
    "transfer": {"points": [point(-300, 0, "#c98a6b"), point(-60, 0.02, "#d9a066"), point(60, 0.05, "#c8553d"), point(180, 0.06, "#c8553d"),
                            point(300, 0.6, "#efe6d0"), point(1200, 1.5, "#ffffff")]},
    "material": {"shading": "phase"},
    "lights": [sun([-0.5, 0.6, 0.8], 9), sun([0.7, 0.2, 0.5], 5)],
    "environment": {"intensity": 0},
    "camera": {"azimuth_deg": 30, "elevation_deg": 8, "zoom": 1.5},
    "image": {"filter": "box", "filter_radius_px": 0.001},
    "render": {"max_scatter": 1},
    "visibility": {"important": [{"range": [300, 1e12]}]},
}

# Brain tissue, in which an atlas says where the deep nuclei are.
MRI = {
    "version": 1,
    "volume": {"path": str(TOP / "data/mri-brain.nii.gz")},
    "proxies": [{"name": "atlas", "path": str(TOP / "data/aal.nii.gz"), "lookup": "nearest"},
                {"name": "left", "kind": "distance", "of": "atlas", "labels": [71, 73, 75, 77, 37]},
                {"name": "right", "kind": "distance", "of": "atlas", "labels": [72, 74, 76, 78, 38]}],
    "transfer": {"points": [point(25, 0, "#b9a48c"), point(60, 0.12, "#c9ab92"), point(110, 0.35, "#efe3d3"), point(200, 0.5, "#ffffff")]},
    "material": {"shading": "phase"},
    "lights": [sun([-0.5, 0.6, 0.8], 12)],
    "environment": {"intensity": 0},
    "camera": {"azimuth_deg": 60, "elevation_deg": 20, "zoom": 1.6},
    "image": {"filter": "box", "filter_radius_px": 0.001},
    "render": {"max_scatter": 1},
    "visibility": {"important": [{"volume": "left", "range": [0, 1e12]}, {"volume": "right", "range": [0, 1e12]}]},
}


def changed(scene, *changes):
    """A copy in which dictionaries are merged key by key; None takes a key out."""
    def merge(into, what):
        for key, value in what.items():
            if value is None:
                into.pop(key, None)
            elif isinstance(value, dict) and isinstance(into.get(key), dict):
                merge(into[key], value)
            else:
                into[key] = copy.deepcopy(value)
    out = copy.deepcopy(scene)
    for change in changes:
        merge(out, change)
    return out


def marched(data, step_units, jitter=False, sums="integral"):
    """What makes a scene be marched in steps of so many halves of the volume's longest side."""
    return {"render": {"integrator": "ray-march", "march_step_voxels": step_units * HALF_SIDE_MM[data] / VOXEL_MM[data],
                       "march_jitter": jitter}, "visibility": {"sums": sums}}


def lights(which, samples=200):
    return {"visibility": {"lights": which, "light_samples": samples}}


HIGHLIGHTS = {"material": {"shading": "blinn-phong", "highlight": 2, "shininess": 40}}
# Emission in place of light: what is seen is opacity alone, and no shadow rays are needed.
GLOWING = {"lights": [], "transfer": {"points": [
    {**p, "emission": p["color"]} for p in CT["transfer"]["points"]]}}
