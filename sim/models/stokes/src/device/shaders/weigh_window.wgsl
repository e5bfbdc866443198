// Mean thickness of the paint, cells above each other. The drag of walls on thin paint acts like mass.

@compute @workgroup_size(256)
fn weigh_columns(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let cells = window.levels[0].cells;
    let columns = cells.x * cells.y;
    var wet = 0.0;
    var some = 0.0;
    for (var k = 0u; k < OWN; k++) {
        let id = (group.x * OWN + k) * 256u + local;
        if id >= columns {
            continue;
        }
        var sum = 0.0;
        for (var z = 0u; z < cells.z; z++) {
            let cell = vec3<i32>(vec3(id % cells.x, id / cells.x, z));
            sum += fields[field(WET) + index(0u, cell)];
        }
        wet += sum;
        some += select(0.0, 1.0, sum > 0.0);
    }
    lanes[local] = wet;
    lanes[256u + local] = some;
    add_lanes(local, group.x, 0u, 2u);
}
