"""Compares the JSON channels of a recording with the lines of `maulstick recording export --format json`.

python foxglove.py RECORDING LINES: prints how many messages its topics have.
"""

import collections, json, sys

from mcap.reader import make_reader

SCALARS = {"boolean": bool, "integer": int, "number": (int, float), "string": str}


def check(schema, value, path):
    """Sees that a value is what a schema of the subset that Foxglove reads says."""
    kind = schema["type"]
    if kind == "object":
        for name, of in schema["properties"].items():
            if name in value:
                check(of, value[name], f"{path}.{name}")
            elif name in schema.get("required", []):
                sys.exit(f"{path}.{name} is missing")
    elif kind == "array":
        assert schema["items"]["type"] != "array", f"{path} is a list of lists"
        for place, item in enumerate(value):
            check(schema["items"], item, f"{path}[{place}]")
    elif not isinstance(value, SCALARS[kind]):
        sys.exit(f"{path} is {value!r} and no {kind}")


def without_null(value):
    if isinstance(value, dict):
        return {name: without_null(own) for name, own in value.items() if own is not None}
    return [without_null(own) for own in value] if isinstance(value, list) else value


lines = {}
for line in map(json.loads, open(sys.argv[2])):
    lines[line["topic"], line["seq"], line["sent_ns"], line["arrived_ns"]] = line
counts = collections.Counter()
with open(sys.argv[1], "rb") as file:
    for schema, channel, message in make_reader(file).iter_messages():
        if channel.message_encoding != "json":
            continue
        assert schema.encoding == "jsonschema", schema.encoding
        told = json.loads(message.data)
        check(json.loads(schema.data), told, channel.topic)
        header = told.pop("header")
        line = lines[channel.topic, header["seq"], message.publish_time, message.log_time]
        stamp = header["stamp"]["sec"] * 10**9 + header["stamp"]["nsec"]
        if told != without_null(line["value"]) or stamp != line["event_ns"]:
            sys.exit(f"{channel.topic}, message {header['seq']} is not what was recorded")
        delay_ms = (line["arrived_ns"] - line["sent_ns"]) * 1e-6
        assert abs(header["delay_ms"] - delay_ms) < 1e-6 * max(1, abs(delay_ms)), channel.topic
        counts[channel.topic] += 1
print(json.dumps(counts))
