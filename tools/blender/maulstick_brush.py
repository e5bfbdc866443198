"""A brush for Maulstick: an armature whose chains of bones are the spines, and a skinned mesh.

Install with Edit > Preferences > Add-ons > Install from Disk; the panel is in the 3D view's sidebar
(N), under Maulstick. From a script: `set_up`, `check` and `export`.
"""

import bpy
from bpy_extras.io_utils import ExportHelper

bl_info = {
    "name": "Maulstick Brush",
    "blender": (4, 2, 0),
    "category": "Import-Export",
    "description": "Sets up, checks and exports a brush for Maulstick",
    "location": "View3D > Sidebar > Maulstick",
}

# Least and greatest value, and what it is; the same ranges as the loader's.
OF_BONES = {
    "stiffness": (1e-6, 1e9, "Bending stiffness EI of the spine at this bone, N mm²"),
    "damping": (0.0, 1.0, "Inner friction: the share of a bend's torque that holds it"),
    "length_m": (1e-6, 0.5, "Length of a spine's last bone, m; set on export"),
}
OF_OBJECTS = {
    "friction": (0.0, 2.0, "Coefficient of friction while sliding"),
    "friction_static": (0.0, 2.0, "Coefficient of friction while sticking"),
    "anisotropy": (0.0, 1.0, "Share of friction that a pulled bristle lacks"),
    "strips": (1, 4096, "Number of bristle strips"),
    "strip_width_mm": (0.01, 50.0, "Width of a strip, mm"),
    "film_um": (0.0, 2000.0, "Paint on a freshly loaded strip, µm"),
    "levels": (0, 3, "Times that the mesh is subdivided"),
    "recede_mm": (0.0, 10.0, "How far the skin draws back as the head opens, mm"),
}
OBJECT_DEFAULTS = {
    "friction": 0.25,
    "friction_static": 0.32,
    "anisotropy": 0.3,
    "strips": 384,
    "film_um": 320.0,
}
DAMPING = 0.01
# Of a round head, N mm² by the square of its width in mm; a point has that share of it.
STIFFNESS_BY_WIDTH = 1.9
AT_THE_POINT = 0.45

MOST_SPINES, MOST_JOINTS, MOST_IN_ALL, MOST_VERTICES = 24, 64, 512, 4096
SIZES_MM = {"width": (0.1, 300.0), "thickness": (0.05, 300.0), "length": (0.5, 500.0)}


def brush_of(context):
    """The armature and the mesh of the active object, either of which may be None."""
    active = context.active_object
    if active and active.type == "MESH":
        return active.find_armature(), active
    if active and active.type == "ARMATURE":
        tied = (
            o for o in context.scene.objects if o.type == "MESH" and o.find_armature() == active
        )
        return active, next(tied, None)
    return None, None


def roots_of(armature):
    """The first bones of all spines: those without a parent, or the children of one that carries
    several."""
    roots = [bone for bone in armature.data.bones if bone.parent is None]
    carrier = next((bone for bone in roots if len(bone.children) > 1), None)
    if carrier:
        roots = [bone for bone in roots if bone != carrier] + list(carrier.children)
    return roots


def spine_from(bone):
    """The bones of a spine, up to its end or to where it branches."""
    spine = [bone]
    while len(spine[-1].children) == 1:
        spine.append(spine[-1].children[0])
    return spine


def ends_mm(armature, bone):
    """Head and tail of a bone in the world, mm."""
    world = armature.matrix_world
    return world @ bone.head_local * 1e3, world @ bone.tail_local * 1e3


def vertices_mm(mesh):
    """The vertices of a mesh in the world, mm."""
    return [mesh.matrix_world @ vertex.co * 1e3 for vertex in mesh.data.vertices]


def give(owner, key, value, known):
    """Adds a custom property, with its range and description, where there is none."""
    if key not in owner:
        owner[key] = value
    least, greatest, description = known[key]
    owner.id_properties_ui(key).update(min=least, max=greatest, description=description)


def set_up(armature, mesh=None):
    """Adds the custom properties of a brush: stiff as a round head that is as wide as the mesh."""
    wide = 2 * max((abs(at.x) for at in vertices_mm(mesh)), default=5.0) if mesh else 10.0
    spines = [spine_from(root) for root in roots_of(armature)]
    whole = STIFFNESS_BY_WIDTH * wide * wide / max(len(spines), 1)
    for spine in spines:
        for i, bone in enumerate(spine):
            share = 1.0 - (1.0 - AT_THE_POINT) * i / len(spine)
            give(bone, "stiffness", whole * share, OF_BONES)
            give(bone, "damping", DAMPING, OF_BONES)
    for key, value in OBJECT_DEFAULTS.items():
        give(armature, key, value, OF_OBJECTS)
    measure_ends(armature)


def measure_ends(armature):
    """Notes the lengths of the last bones, which glTF does not have."""
    for root in roots_of(armature):
        last = spine_from(root)[-1]
        head, tail = ends_mm(armature, last)
        last["length_m"] = (tail - head).length * 1e-3


def slips(one, other):
    """Letters to change, add, drop or swap to make one word the other."""
    before, row = [], list(range(len(other) + 1))
    for i, a in enumerate(one, 1):
        earlier, before, row = before, row, [i]
        for j, b in enumerate(other, 1):
            row.append(min(before[j] + 1, row[-1] + 1, before[j - 1] + (a != b)))
            if i > 1 and j > 1 and a == other[j - 2] and one[i - 2] == b:
                row[-1] = min(row[-1], earlier[j - 2] + 1)
    return row[-1]


def near(own, key):
    """Whether a key is a property but for case, a unit behind it, or a slip or two."""
    key = key.lower()
    longer = own.startswith(key + "_") or key.startswith(own + "_")
    return longer or slips(own, key) <= min(max(len(own) // 3, 1), 2)


def check_properties(owner, known, others, required):
    """What is wrong with the custom properties of an object or a bone."""
    texts = {"kind"} if known is OF_OBJECTS else set()
    for key in required:
        if key not in owner:
            yield f"'{owner.name}' has no '{key}': use Set up brush"
    for key, value in owner.items():
        if key in known:
            least, greatest, _ = known[key]
            number = isinstance(value, (int, float)) and not isinstance(value, bool)
            whole = isinstance(least, float) or number and float(value).is_integer()
            if not (number and whole and least <= value <= greatest):
                yield f"'{key}' of '{owner.name}' is {value}, but must be {least:g} to {greatest:g}"
        elif key in texts:
            if not isinstance(value, str) or not value:
                yield f"'{key}' of '{owner.name}' must be a name"
        elif not key.startswith("_"):
            meant = next((own for own in [*known, *texts, *others] if near(own, key)), None)
            if meant in others:
                place = "on a bone" if known is OF_OBJECTS else "on the object"
                yield f"'{key}' of '{owner.name}' does nothing: '{meant}' belongs {place}"
            elif meant:
                yield f"'{key}' of '{owner.name}' does nothing: did you mean '{meant}'?"


def check_bones(armature):
    """What is wrong with the bones of an armature."""
    spines = [spine_from(root) for root in roots_of(armature)]
    if not spines:
        yield f"'{armature.name}' has no bones: give each spine a chain of them"
    if len(spines) > MOST_SPINES:
        yield f"there are {len(spines)} spines, but must be at most {MOST_SPINES}"
    if sum(map(len, spines)) > MOST_IN_ALL:
        yield f"there are {sum(map(len, spines))} bones, but must be at most {MOST_IN_ALL}"
    for spine in spines:
        if len(spine) > MOST_JOINTS:
            yield f"the spine of bone '{spine[0].name}' has {len(spine)} bones, at most {MOST_JOINTS}"
        if spine[-1].children:
            names = ", ".join(f"'{bone.name}'" for bone in spine[-1].children)
            yield f"bone '{spine[-1].name}' branches to {names}: only one root bone may"
        (root, _), (_, end) = ends_mm(armature, spine[0]), ends_mm(armature, spine[-1])
        if end.z >= root.z:
            yield f"the spine of bone '{spine[0].name}' does not hang along -Z"
        for bone in spine:
            after = bone.children[0] if bone.children else None
            head, tail = ends_mm(armature, bone)
            end = ends_mm(armature, after)[0] if after else tail
            if (end - head).length < 1e-3:
                yield f"bone '{bone.name}' has no length"
    bending = {bone.name for spine in spines for bone in spine}
    for bone in armature.data.bones:
        required = ["stiffness", "damping"] if bone.name in bending else []
        yield from check_properties(bone, OF_BONES, OF_OBJECTS, required)
    for bone in armature.pose.bones:
        for key in set(OF_BONES).intersection(bone.keys()):
            yield f"'{key}' of '{bone.name}' is set in Pose Mode, which is not exported"


def check_mesh(armature, mesh):
    """What is wrong with the mesh and its weights."""
    groups = {group.index for group in mesh.vertex_groups if group.name in armature.data.bones}

    def tied(vertex):
        # The exporter drops what is lighter.
        return any(g.group in groups and g.weight > 1e-4 for g in vertex.groups)

    bare = [vertex.index for vertex in mesh.data.vertices if not tied(vertex)]
    if bare:
        some = ", ".join(map(str, bare[:8])) + (", ..." if len(bare) > 8 else "")
        yield f"{len(bare)} vertices of '{mesh.name}' have no weights: {some}"
    if len(mesh.data.vertices) > MOST_VERTICES:
        yield f"'{mesh.name}' has {len(mesh.data.vertices)} vertices, at most {MOST_VERTICES}"
    if not mesh.data.polygons:
        yield f"'{mesh.name}' has no faces"
    below = [at for at in vertices_mm(mesh) if at.z < 0.0]
    if not below:
        yield f"'{mesh.name}' does not hang along -Z from the origin"
        return
    sizes = {
        "width": 2 * max(abs(at.x) for at in below),
        "thickness": 2 * max(abs(at.y) for at in below),
        "length": -min(at.z for at in below),
    }
    for name, mm in sizes.items():
        least, greatest = SIZES_MM[name]
        if not least <= mm <= greatest:
            yield f"the head's {name} is {mm:g} mm, but must be {least:g} to {greatest:g}"


def check(armature, mesh):
    """Everything that keeps a model from being a brush, one sentence each."""
    if armature is None or mesh is None:
        return ["select a mesh that is parented to an armature (Ctrl+P, With Automatic Weights)"]
    problems = [*check_bones(armature), *check_mesh(armature, mesh)]
    for owner in (armature, mesh, mesh.data):
        problems += check_properties(owner, OF_OBJECTS, OF_BONES, [])
    # The mesh goes before its armature.
    brush = {**armature, **mesh.data, **mesh}
    if "friction" not in brush:
        problems.append(f"'{armature.name}' has no 'friction': use Set up brush")
    elif not problems and brush.get("friction_static", 2.0) < brush["friction"]:
        problems.append("'friction_static' is less than 'friction': sticking takes no less force")
    return problems


def export(armature, mesh, path):
    """Writes the brush as a .glb.

    Raises ValueError with what `check` finds.
    """
    problems = check(armature, mesh)
    if problems:
        raise ValueError("\n".join(problems))
    write(armature, mesh, path)


def write(armature, mesh, path):
    """Writes a model as a .glb."""
    measure_ends(armature)
    for other in bpy.context.scene.objects:
        other.select_set(other in (armature, mesh))
    bpy.ops.export_scene.gltf(
        filepath=str(path),
        export_format="GLB",
        use_selection=True,
        export_extras=True,
        export_yup=True,
        export_rest_position_armature=True,
        export_animations=False,
        export_materials="NONE",
        export_normals=False,
        export_texcoords=False,
    )


class SetUp(bpy.types.Operator):
    """Add the custom properties of a brush, stiff as a round head that is as wide"""

    bl_idname = "maulstick.set_up"
    bl_label = "Set up brush"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.mode == "OBJECT" and brush_of(context)[0] is not None

    def execute(self, context):
        set_up(*brush_of(context))
        return {"FINISHED"}


class Check(bpy.types.Operator):
    """Say what keeps the model from being a brush"""

    bl_idname = "maulstick.check"
    bl_label = "Check brush"

    @classmethod
    def poll(cls, context):
        return context.mode == "OBJECT"

    def execute(self, context):
        problems = check(*brush_of(context))
        for problem in problems:
            self.report({"WARNING"}, problem)
        if not problems:
            self.report({"INFO"}, "The brush is good")
        return {"FINISHED"}


class Export(bpy.types.Operator, ExportHelper):
    """Check the brush and write it as a .glb"""

    bl_idname = "maulstick.export"
    bl_label = "Export brush"
    filename_ext = ".glb"
    filter_glob: bpy.props.StringProperty(default="*.glb", options={"HIDDEN"})

    @classmethod
    def poll(cls, context):
        return context.mode == "OBJECT"

    def execute(self, context):
        try:
            export(*brush_of(context), self.filepath)
        except ValueError as problems:
            self.report({"ERROR"}, str(problems))
            return {"CANCELLED"}
        return {"FINISHED"}


class Panel(bpy.types.Panel):
    """The three steps from a model to a brush"""

    bl_idname = "VIEW3D_PT_maulstick"
    bl_label = "Maulstick Brush"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Maulstick"

    def draw(self, context):
        for operator in (SetUp, Check, Export):
            self.layout.operator(operator.bl_idname)


CLASSES = (SetUp, Check, Export, Panel)


def register():
    """Adds the panel and its operators."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    """Takes them away."""
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
