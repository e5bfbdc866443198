"""Maulstick's streams in Python: messages by name, of a recording or of a running rig.

pip install eclipse-zenoh mcap. `maulstick` is asked for the message formats, unless they come with the recording.
"""

import functools, io, json, random, re, struct, subprocess, time

HEADER = struct.Struct("<HHIIIIIQQQ")
FIELDS = ("magic", "version", "schema", "source", "epoch", "flags", "length", "seq", "event_ns", "sent_ns")
PLAIN = dict(u8="<B", u16="<H", u32="<I", u64="<Q", i32="<i", i64="<q", f32="<f", f64="<d", bool="<?")

# Bits of `senses`, see docs/messages.md.
POSITION, ORIENTATION, PRESSURE, TILT, TWIST, SWITCHES, PROXIMITY, FORCE, VELOCITY, TORQUE = (1 << bit for bit in range(10))
# A pressed eraser in `switches`.
ERASER = 1 << 31
# Fields that are left out are 0, none or empty, but for these.
DEFAULTS = {
    ("StylusSample", "senses"): lambda sample: POSITION | (ORIENTATION if "Ferrule" in sample.get("pose", {}) else PRESSURE),
    ("StylusSample", "in_range"): True,
    ("StylusPose.Contact", "tilt_rad"): [0.38759668665518066, -0.38759668665518066],
    ("Pose", "orientation"): [0.0, 0.0, 0.0, 1.0],
}


class FieldError(ValueError):
    """A value that a message has no room for; says which fields there are."""


def split(message):
    """Header and body of a message."""
    header = dict(zip(FIELDS, HEADER.unpack_from(message)))
    if header["magic"] != 0x4D4C or header["length"] != len(message) - HEADER.size:
        raise ValueError("this is no message of Maulstick")
    return header, message[HEADER.size :]


class Table:
    """The field table of a message, from `maulstick schema --json` or a recording."""

    def __init__(self, schema):
        self.name, self.hash, self.types = schema["name"], schema["hash"], schema["types"]
        self.version = schema.get("version", 1)

    def decode(self, body):
        """The fields of a body, as dicts, lists and numbers; what a newer version appended is left alone."""
        return self._read(self.name, io.BytesIO(body))

    def encode(self, value):
        """The body of a message; fields that are left out have their defaults, see DEFAULTS."""
        return self._write(self.name, value)

    def fields(self):
        """Names and types of its fields."""
        return {field["name"]: field["type"] for field in self.types[self.name]["struct"]}

    def _read(self, kind, body):
        form, inner, count = _parts(kind)
        if form in PLAIN:
            return struct.unpack(PLAIN[form], body.read(struct.calcsize(PLAIN[form])))[0]
        if form == "Option":
            return self._read(inner, body) if self._read("bool", body) else None
        if form == "Vec":
            count = self._read("u64", body)
            if count > len(body.getbuffer()) - body.tell():
                raise ValueError("the message ends early")
        if kind == "Vec<u8>":
            return body.read(count)
        if kind == "String":
            return self._read("Vec<u8>", body).decode()
        if form in ("Vec", "array"):
            return [self._read(inner, body) for _ in range(count)]
        shape = self.types[kind]
        if "struct" in shape:
            return self._read_fields(shape["struct"], body)
        variant = shape["enum"][self._read("u32", body)]
        return {variant["name"]: self._read_fields(variant["fields"], body)}

    def _read_fields(self, fields, body):
        return {field["name"]: self._read(field["type"], body) for field in fields}

    def _write(self, kind, value):
        form, inner, count = _parts(kind)
        if form in PLAIN:
            return struct.pack(PLAIN[form], value)
        if form == "Option":
            return b"\0" if value is None else b"\1" + self._write(inner, value)
        if kind == "String":
            return self._write("Vec<u8>", value.encode())
        if form in ("Vec", "array"):
            if count not in (None, len(value)):
                raise TypeError(f"it has {count} values, not {len(value)}")
            length = self._write("u64", len(value)) if form == "Vec" else b""
            return length + b"".join(self._write(inner, item) for item in value)
        shape = self.types[kind]
        if "struct" in shape:
            return self._write_fields(kind, shape["struct"], value)
        variants = {variant["name"]: variant["fields"] for variant in shape["enum"]}
        if not isinstance(value, dict) or len(value) != 1 or not value.keys() <= variants.keys():
            raise FieldError(f"{value!r} is none of {self._choices(kind)}")
        ((name, fields),) = value.items()
        tag = list(variants).index(name)
        return self._write("u32", tag) + self._write_fields(f"{kind}.{name}", variants[name], fields)

    def _write_fields(self, owner, fields, value):
        names = ", ".join(field["name"] for field in fields) or "none"
        if not isinstance(value, dict):
            raise FieldError(f"{owner} is a dict of its fields, not {value!r}; its fields: {names}")
        unknown = value.keys() - {field["name"] for field in fields}
        if unknown:
            raise FieldError(f"{owner} has no field {min(unknown)!r}; its fields: {names}")
        return b"".join(self._write_field(owner, field["name"], field["type"], value) for field in fields)

    def _write_field(self, owner, name, kind, value):
        try:
            return self._write(kind, value[name] if name in value else self._default(owner, name, kind, value))
        except (struct.error, TypeError, AttributeError) as error:
            raise FieldError(f"{owner}.{name} is of type {kind}, not {value[name]!r}: {error}") from None

    def _default(self, owner, name, kind, value):
        """What a field holds that is left out."""
        if (owner, name) in DEFAULTS:
            default = DEFAULTS[owner, name]
            return default(value) if callable(default) else default
        form, inner, count = _parts(kind)
        if form in PLAIN:
            return 0
        if form == "array":
            return [self._default(owner, name, inner, value)] * count
        if form in ("Option", "Vec", "String"):
            return {"Option": None, "Vec": [], "String": ""}[form]
        if "struct" in self.types[kind]:
            return {}
        raise FieldError(f"{owner} needs its field {name!r}, one of {self._choices(kind)}")

    def _choices(self, kind):
        shown = lambda variant: f"{variant['name']} ({', '.join(field['name'] for field in variant['fields'])})"
        return ", ".join(shown(variant) for variant in self.types[kind]["enum"])


@functools.cache
def _parts(kind):
    """Form, inner type and length of a type such as Vec<u8>, Option<Pose> or [f64; 3]."""
    if kind.startswith("["):
        inner, count = kind[1:-1].rsplit("; ", 1)
        return "array", inner, int(count)
    form, _, inner = kind.removesuffix(">").partition("<")
    return form, inner, None


def recording(path, *topics):
    """Messages of a recording or take: topic, seconds of arrival on the rig's clock, header, fields. Of all topics, or of those
    that match one of the patterns."""
    from mcap.exceptions import McapError
    from mcap.reader import NonSeekingReader

    tables, topics = {}, topics or ("**",)
    is_meant = lambda topic: any(_matches(pattern, topic) for pattern in topics)
    with open(path, "rb") as file:
        try:
            for schema, channel, message in NonSeekingReader(file).iter_messages(log_time_order=False):
                if schema and schema.encoding == "x-maulstick-fields+json" and is_meant(channel.topic):
                    if schema.id not in tables:
                        tables[schema.id] = Table(json.loads(schema.data))
                    header, body = split(message.data)
                    yield channel.topic, message.log_time * 1e-9, header, tables[schema.id].decode(body)
        except McapError:  # where a recorder was killed
            return


def _matches(pattern, topic):
    stars = {"*": "/[^/]+", "**": "(/[^/]+)*"}
    parts = [stars.get(part, "/" + re.escape(part)) for part in pattern.split("/")]
    return re.fullmatch("".join(parts), "/" + topic)


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
        if message not in self.by_name:
            raise FieldError(f"there is no message {message!r}; there are {', '.join(sorted(self.by_name))}")
        return Sender(self, topic, self.by_name[message])


class Sender:
    """Sends messages of one kind on a topic, and answers for those that were lost."""

    def __init__(self, rig, topic, table, keeps=5000):
        self.rig, self.table, self.keeps = rig, table, keeps
        self.source, self.epoch = random.getrandbits(32), random.getrandbits(32) | 1
        self.seq, self.sent = 0, {}
        self.publisher = rig.session.declare_publisher(rig.facts["prefix"] + topic)
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
            sent = list(self.sent.items())  # at once: the other thread goes on sending
            found = [message for seq, message in sent if asked["from"] <= seq <= asked["to"]]
            query.reply(query.key_expr, b"".join(found))
