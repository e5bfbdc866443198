"""A stylus in Python: it draws a circle.  Usage: maulstick endpoint --json | python stylus.py"""

import json, math, random, struct, sys, time
import zenoh

SCHEMA = 0xf5672178  # `maulstick schema StylusSample`
POSITION, PRESSURE = 1, 4
rig = json.load(sys.stdin)
config = zenoh.Config.from_json5(json.dumps({"mode": "client", "connect": {"endpoints": [rig["endpoint"]]}}))
with zenoh.open(config) as session:
    topic = session.declare_publisher(rig["prefix"] + "stylus/python/sample")
    epoch = random.randrange(1, 2**32)
    for n in range(600):
        angle = 2 * math.pi * n / 500
        x, y = 0.06 * math.cos(angle), 0.06 * math.sin(angle)  # m from the middle of the desk
        pressure = 0.6 if 50 < n < 550 else 0.0
        pen = struct.pack("<I3d2ddd", 1, x, y, 0, 0.3, -0.3, 0, pressure)
        body = struct.pack("<I", POSITION | PRESSURE) + pen + struct.pack("<6dIB", *[0] * 6, 0, True)
        now = time.monotonic_ns() + rig["clock_offset_ns"]
        topic.put(struct.pack("<HHIIIIIQQQ", 0x4D4C, 1, SCHEMA, 0x5079, epoch, 0, len(body), n, now, now) + body)
        time.sleep(0.002)
