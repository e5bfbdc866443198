"""Plots pressure and speed of the hand in a recording.

    python3 plot_pressure.py session.mcap out.png          (pip install mcap matplotlib)
"""

import math, pathlib, sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plot

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "msgs/python"))
import maulstick

times, pressures, speeds, last = [], [], [], None
for topic, seconds, header, sample in maulstick.recording(sys.argv[1], "stylus/*/sample"):
    contact = sample["pose"].get("Contact")
    if not contact or not sample["in_range"]:
        continue
    here = header["event_ns"] * 1e-9, contact["point_m"]
    if last and here[0] > last[0]:
        speeds.append(math.dist(here[1], last[1]) / (here[0] - last[0]))
        times.append(here[0])
        pressures.append(contact["pressure"])
    last = here
if not times:
    sys.exit("the recording holds no samples of a pen or a mouse")
figure, (above, below) = plot.subplots(2, sharex=True, figsize=(8, 4))
times = [time - times[0] for time in times]
above.plot(times, pressures, color="#1f4e8c")
above.set_ylabel("pressure")
below.plot(times, [speed * 1e3 for speed in speeds], color="#a63e00")
below.set_ylabel("speed, mm/s")
below.set_xlabel("s")
figure.tight_layout()
figure.savefig(sys.argv[2], dpi=110)
