//! The network keeps its promises.

use super::*;

#[test]
fn expressions_match_as_zenoh_does() {
    for (expression, key, expected) in [
        ("a/b", "a/b", true),
        ("a/*", "a/b", true),
        ("a/*/c", "a/b/c", true),
        ("a/*", "a/b/c", false),
        ("a/**", "a", true),
        ("a/**", "a/b/c", true),
        ("**/c", "a/b/c", true),
        ("a/b", "a/c", false),
    ] {
        assert_eq!(matches(expression, key), expected, "{expression} {key}");
    }
}

#[test]
fn nothing_arrives_before_its_time_and_late_joiners_get_cached_values() {
    let net = MemoryNet::new(
        1,
        0,
        Faults {
            loss: 0.0,
            delay_ns: 1000,
        },
    );
    let wake = Wake::new();
    let bus = net.bus();
    bus.publisher("a/def", Qos::Cached)
        .expect("a publisher")
        .put(vec![7])
        .expect("sent");
    let late = net
        .bus()
        .subscribe("a/*", Qos::Cached, Queue::Ring(4), &wake)
        .expect("late");
    assert_eq!(late.try_recv().map(|arrival| arrival.bytes), Some(vec![7]));
    let server = bus.serve("q", 4, &wake).expect("a server");
    let pending = bus
        .ask("q", Qos::Control, vec![1], Duration::from_millis(1), &wake)
        .expect("asked");
    assert!(server.try_recv().is_none());
    net.advance(1000);
    server
        .try_recv()
        .expect("a question")
        .answer(vec![2])
        .expect("answered");
    net.advance(1000);
    assert_eq!(pending.try_recv(), Some(Answer::Bytes(vec![2].into())));
    net.advance(1_000_000);
    assert_eq!(pending.try_recv(), Some(Answer::Ended));
}
