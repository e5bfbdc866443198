"""A tracker as a brush: the poses that OpenTrack sends ("UDP over network") hold the ferrule.

Usage: maulstick endpoint --json | python tracker.py [--port 4242] [--device tracker]

A datagram is six little-endian doubles: x, y, z in cm, yaw, pitch, roll in degrees. x goes to the
right, y up along the canvas, z toward the painter; the body is turned about y by yaw, then about its
own x by pitch, then about its own z by roll. Unturned, the bristles point at the canvas.
"""

import argparse, json, math, random, signal, socket, struct, sys, time
import zenoh

SCHEMA = 0xf5672178  # `maulstick schema StylusSample`
POSITION, ORIENTATION = 1, 2
SILENCE_S = 0.2  # a tracker that says nothing for so long has lost its body
FARTHEST_M = 10.0


def turn(axis, degrees):
    """A rotation about an axis of the frame: x, y, z, w."""
    half = math.radians(degrees) / 2
    quaternion = [0.0, 0.0, 0.0, math.cos(half)]
    quaternion[axis] = math.sin(half)
    return quaternion


def after(a, b):
    """First b, then a."""
    (ax, ay, az, aw), (bx, by, bz, bw) = a, b
    return [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]


def pose(datagram):
    """Position in m and unit quaternion with w >= 0, or None for what is no pose."""
    if len(datagram) != 48:
        return None
    numbers = struct.unpack("<6d", datagram)
    place = [cm / 100 for cm in numbers[:3]]
    if not all(map(math.isfinite, numbers)) or any(abs(m) > FARTHEST_M for m in place):
        return None
    yaw, pitch, roll = numbers[3:]
    q = after(turn(1, yaw), after(turn(0, pitch), turn(2, roll)))
    return place + [-part if q[3] < 0 else part for part in q]


options = argparse.ArgumentParser(description="A tracker as a brush")
options.add_argument("--port", type=int, default=4242, help="UDP port to listen on; 0 for a free one")
options.add_argument("--host", default="127.0.0.1", help="address to listen on; 0.0.0.0 for other machines")
options.add_argument("--device", default="tracker", help="name of the device, as in rig.toml")
options = options.parse_args()
rig = json.load(sys.stdin)
config = zenoh.Config.from_json5(json.dumps({"mode": "client", "connect": {"endpoints": [rig["endpoint"]]}}))
signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
with zenoh.open(config) as session, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as tracker:
    topic = session.declare_publisher(f"{rig['prefix']}stylus/{options.device}/sample")
    epoch, number = random.randrange(1, 2**32), 0

    def send(held, in_range):
        global number
        body = struct.pack("<2I7d", POSITION | ORIENTATION, 0, *held) + struct.pack("<6dIB", *[0] * 6, 0, in_range)
        now = time.monotonic_ns() + rig["clock_offset_ns"]
        header = struct.pack("<HHIIIIIQQQ", 0x4D4C, 1, SCHEMA, 0x7472, epoch, 0, len(body), number, now, now)
        topic.put(header + body)
        number += 1

    tracker.bind((options.host, options.port))
    tracker.settimeout(SILENCE_S)
    print("listening on {}:{}".format(*tracker.getsockname()), file=sys.stderr, flush=True)
    heard_s, newest = time.monotonic(), None
    try:
        while True:
            try:
                held = pose(tracker.recv(4096))
            except socket.timeout:
                held = None
            if held:
                heard_s, newest = time.monotonic(), held
                send(held, True)
            elif newest and time.monotonic() - heard_s >= SILENCE_S:
                send(newest, False)
                newest = None
    except KeyboardInterrupt:
        pass
    finally:
        if newest:
            send(newest, False)
