"""Maulstick's streams in Python: messages by name, of a recording or of a running rig.

pip install eclipse-zenoh mcap. `maulstick` is asked for the message formats, unless they come with the recording.
"""

import json, random, struct, subprocess, time

HEADER = struct.Struct("<HHIIIIIQQQ")
FIELDS = ("magic", "version", "schema", "source", "epoch", "flags", "length", "seq", "event_ns", "sent_ns")
PLAIN = dict(u8="B", u16="H", u32="I", u64="Q", i32="i", i64="q", f32="f", f64="d", bool="?")


class Table:
    """The field table of a message, from `maulstick schema --json` or a recording."""

    def __init__(self, schema):
        self.name, self.hash, self.types = schema["name"], schema["hash"], schema["types"]
        self.version = schema.get("version", 1)

    def decode(self, body):
        """The fields of a body, as dicts, lists and numbers; what a newer version appended is left alone."""
        return self._read(self.name, body, 0)[0]

    def encode(self, value):
        return self._write(self.name, value)

    def _read(self, kind, data, at):
        if kind in PLAIN:
            plain = struct.Struct("<" + PLAIN[kind])
            return plain.unpack_from(data, at)[0], at + plain.size
        if kind == "String" or kind.startswith("Vec<"):
            count, at = self._read("u64", data, at)
            if count > len(data) - at:
                raise ValueError("the message ends early")
            if kind in ("String", "Vec<u8>"):
                found = bytes(data[at : at + count])
                return found.decode() if kind == "String" else found, at + count
            return self._several(kind[4:-1], count, data, at)
        if kind.startswith("Option<"):
            return self._read(kind[7:-1], data, at + 1) if data[at] else (None, at + 1)
        if kind.startswith("["):
            of, count = kind[1:-1].rsplit("; ", 1)
            return self._several(of, int(count), data, at)
        shape = self.types[kind]
        if "struct" in shape:
            return self._fields(shape["struct"], data, at)
        tag, at = self._read("u32", data, at)
        fields, at = self._fields(shape["enum"][tag]["fields"], data, at)
        return {shape["enum"][tag]["name"]: fields}, at

    def _several(self, kind, count, data, at):
        found = []
        for _ in range(count):
            value, at = self._read(kind, data, at)
            found.append(value)
        return found, at

    def _fields(self, fields, data, at):
        found = {}
        for field in fields:
            found[field["name"]], at = self._read(field["type"], data, at)
        return found, at

    def _write(self, kind, value):
        if kind in PLAIN:
            return struct.pack("<" + PLAIN[kind], value)
        if kind in ("String", "Vec<u8>"):
            value = value.encode() if kind == "String" else value
            return struct.pack("<Q", len(value)) + value
        if kind.startswith("Vec<"):
            return struct.pack("<Q", len(value)) + b"".join(self._write(kind[4:-1], item) for item in value)
        if kind.startswith("Option<"):
            return b"\0" if value is None else b"\1" + self._write(kind[7:-1], value)
        if kind.startswith("["):
            of, count = kind[1:-1].rsplit("; ", 1)
            if len(value) != int(count):
                raise ValueError(f"{kind} has {count} values, not {len(value)}")
            return b"".join(self._write(of, item) for item in value)
        shape = self.types[kind]
        if "struct" in shape:
            return b"".join(self._write(field["type"], value[field["name"]]) for field in shape["struct"])
        (name, fields), = value.items()
        tag = [variant["name"] for variant in shape["enum"]].index(name)
        own = shape["enum"][tag]["fields"]
        return struct.pack("<I", tag) + b"".join(self._write(field["type"], fields[field["name"]]) for field in own)


def recording(path, topics="**"):
    """Messages of a recording or take: topic, seconds of arrival on the rig's clock, header, fields."""
    from mcap.exceptions import McapError
    from mcap.records import Channel, Message, Schema
    from mcap.stream_reader import StreamReader

    schemas, channels = {}, {}
    with open(path, "rb") as file:
        records = iter(StreamReader(file).records)
        while True:
            try:
                record = next(records)
            except (StopIteration, McapError):  # the end, or where a recorder was killed
                return
            if isinstance(record, Schema) and record.encoding == "x-maulstick-fields+json":
                schemas[record.id] = Table(json.loads(record.data))
            elif isinstance(record, Channel):
                channels[record.id] = record.topic, schemas.get(record.schema_id)
            elif isinstance(record, Message):
                topic, table = channels[record.channel_id]
                if table and _means(topics, topic):
                    header, body = split(record.data)
                    yield topic, record.log_time * 1e-9, header, table.decode(body)


def split(message):
    """Header and body of a message."""
    header = dict(zip(FIELDS, HEADER.unpack_from(message)))
    if header["magic"] != 0x4D4C or header["length"] != len(message) - HEADER.size:
        raise ValueError("this is no message of Maulstick")
    return header, message[HEADER.size :]


def _means(pattern, topic):
    return _match(pattern.split("/"), topic.split("/"))


def _match(pattern, topic):
    if not pattern:
        return not topic
    if pattern[0] == "**":
        return any(_match(pattern[1:], topic[at:]) for at in range(len(topic) + 1))
    return bool(topic) and pattern[0] in ("*", topic[0]) and _match(pattern[1:], topic[1:])


class Rig:
    """A running rig: `with Rig() as rig: …`."""

    def __init__(self, name="studio", program="maulstick"):
        import zenoh

        ask = lambda *words: json.loads(subprocess.check_output([program, *words, "--json"]))
        self.facts = ask("endpoint", "--name", name)
        tables = [Table(message) for message in ask("schema")["messages"]]
        self.by_hash = {table.hash: table for table in tables}
        self.by_name = {table.name: table for table in tables}
        connect = {"mode": "client", "connect": {"endpoints": [self.facts["endpoint"]]}}
        self.session = zenoh.open(zenoh.Config.from_json5(json.dumps(connect)))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.session.close()

    def now_ns(self):
        return time.monotonic_ns() + self.facts["clock_offset_ns"]

    def listen(self, topics):
        """Messages of topics as they come: topic, header, fields. Those that this program does not know are left out."""
        with self.session.declare_subscriber(self.facts["prefix"] + topics) as subscriber:
            for sample in subscriber:
                try:
                    header, body = split(sample.payload.to_bytes())
                except (ValueError, struct.error):  # none of Maulstick's
                    continue
                if table := self.by_hash.get(header["schema"]):
                    yield str(sample.key_expr).removeprefix(self.facts["prefix"]), header, table.decode(body)

    def sender(self, topic, message):
        return Sender(self, topic, self.by_name[message])


class Sender:
    """Sends messages of one kind on a topic, and answers for those that were lost."""

    def __init__(self, rig, topic, table, keeps=5000):
        self.rig, self.table, self.keeps = rig, table, keeps
        self.source, self.epoch, self.sent = random.getrandbits(32), random.getrandbits(32) | 1, {}
        self.key, self.seq = rig.facts["prefix"] + topic, 0
        self.publisher = rig.session.declare_publisher(self.key)
        self.gaps = rig.session.declare_queryable(rig.facts["prefix"] + "gap/" + topic, self._answer)

    def send(self, value, event_ns=None):
        body, now = self.table.encode(value), self.rig.now_ns()
        flags, event = 0 if self.seq else 2, now if event_ns is None else event_ns
        head = (0x4D4C, self.table.version, self.table.hash, self.source, self.epoch, flags, len(body), self.seq, event, now)
        self.sent[self.seq] = HEADER.pack(*head) + body
        self.publisher.put(self.sent[self.seq])
        self.sent.pop(self.seq - self.keeps, None)
        self.seq += 1

    def _answer(self, query):
        asked = self.rig.by_name["GapRequest"].decode(split(query.payload.to_bytes())[1])
        if asked["epoch"] == self.epoch:
            wanted = range(asked["from"], min(asked["to"], self.seq) + 1)
            found = [self.sent.get(seq, b"") for seq in wanted[: self.keeps]]
            query.reply(query.key_expr, b"".join(found))
