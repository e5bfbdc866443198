// Sums over fields: each workgroup has partial sums of up to SUMS products, which one workgroup then adds up. The order
// is fixed, so a device reproduces its bytes.

const SUMS = 15u;
// Number of values of an invocation.
const OWN = 8u;

// Less than the 16,352 bytes that every device has.
var<workgroup> lanes: array<f32, 3840>;

// Writes the workgroup's sum of each of `count` values that its invocations left in `lanes`, as rows of 256.
fn add_lanes(local: u32, group: u32, first: u32, count: u32) {
    workgroupBarrier();
    // Sixteen invocations a sum.
    let sum = local / 16u;
    var total = 0.0;
    for (var i = 0u; i < 16u && sum < SUMS; i++) {
        total += lanes[sum * 256u + 16u * (local % 16u) + i];
    }
    workgroupBarrier();
    lanes[local] = total;
    workgroupBarrier();
    if local < count {
        var whole = 0.0;
        for (var i = 0u; i < 16u; i++) {
            whole += lanes[16u * local + i];
        }
        fields[window.partials + (first + local) * call.groups + group] = whole;
    }
    workgroupBarrier();
}
