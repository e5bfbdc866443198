"""Plots the force on a hand against how deep its brush is pressed.

    python3 plot_force.py session.mcap out.png              (pip install mcap matplotlib)
    python3 plot_force.py --rig studio out.png --seconds 10 (pip install eclipse-zenoh matplotlib; `maulstick` in the path)

Of several devices --device names one.
"""

import argparse, pathlib, sys, time

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plot

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "msgs/python"))
import maulstick

TOPICS = "stylus/*/sample", "haptics/*/model"


def live(rig, seconds):
    """Messages of a running rig for some seconds, as of a recording."""
    end = time.monotonic() + seconds
    for topic, header, fields in rig.listen("*/*/*"):
        if time.monotonic() > end:
            return
        yield topic, header["event_ns"] * 1e-9, header, fields


def curve(messages, device):
    """Depths, m, forces along the surface's normal, N, and the length of the head, m."""
    depths, forces, length, force = [], [], None, None
    for topic, _, _, fields in messages:
        kind, name, what = topic.split("/")[:3]
        if device not in (None, name):
            continue
        if (kind, what) == ("stylus", "sample"):
            force = fields["force_n"] if fields["in_range"] else None
        elif (kind, what) == ("haptics", "model") and force:
            # The newest force at the place that the model was made for.
            depths.append(fields["depth_m"])
            forces.append(sum(f * n for f, n in zip(force, fields["plane_normal"])))
            length = fields["head_length_m"]
    return depths, forces, length


words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
words.add_argument("recording", nargs="?", help="recording; without one a rig that runs")
words.add_argument("output", help="PNG to write")
words.add_argument("--rig", default="studio", help="name of the rig [studio]")
words.add_argument("--seconds", type=float, default=10, help="how long to listen to it, s [10]")
words.add_argument("--device", help="the device, such as arm")
words = words.parse_args()

if words.recording:
    depths, forces, length = curve(maulstick.recording(words.recording, *TOPICS), words.device)
else:
    with maulstick.Rig(words.rig) as rig:
        depths, forces, length = curve(live(rig, words.seconds), words.device)
if not depths:
    sys.exit("no device with force was heard: a contact model is on haptics/<device>/model")
if not any(depths):
    sys.exit("the recording was made before contact models had a depth: record anew")

figure, axes = plot.subplots(figsize=(6, 4))
axes.plot([depth * 1e3 for depth in depths], forces, ".", markersize=3, color="#1f4e8c")
axes.axvline(0, color="#888", linewidth=0.8)
axes.set_xlabel("depth of the unbent tip, mm")
axes.set_ylabel("force along the normal, N")
share = axes.secondary_xaxis("top", functions=(lambda mm: mm * 1e-3 / length, lambda share: share * length * 1e3))
share.set_xlabel(f"depth, as a share of the head's {length * 1e3:.1f} mm")
figure.tight_layout()
figure.savefig(words.output, dpi=110)
print(f"{len(depths)} contact models, {max(depths) * 1e3:.1f} mm at most, {max(forces):.2f} N at most")
