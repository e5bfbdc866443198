//! The graph as text of Mermaid: a box for each process, an arrow for all that one sends another.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::processes::Graph;

/// The text.
#[must_use]
pub fn text(graph: &Graph) -> String {
    let mut text = "flowchart LR\n".to_owned();
    for (place, process) in graph.processes.iter().enumerate() {
        let mut lines = vec![escaped(&process.name)];
        let answers = process.answers.iter();
        lines.extend(answers.map(|topic| format!("answers {}", escaped(topic))));
        writeln!(text, "    n{place}[\"{}\"]", lines.join("<br/>")).ok();
    }
    let mut labels: BTreeMap<(usize, usize), Vec<String>> = BTreeMap::new();
    for arrow in &graph.arrows {
        let labels = labels.entry((arrow.from, arrow.to)).or_default();
        labels.push(escaped(&graph.sent(arrow).label()));
    }
    for ((from, to), labels) in labels {
        let labels = labels.join("<br/>");
        writeln!(text, "    n{from} -->|\"{labels}\"| n{to}").ok();
    }
    text
}

/// A text in which only letters, digits and harmless signs stand for themselves: foreign programs choose their topics.
fn escaped(text: &str) -> String {
    let mut safe = String::new();
    for letter in text.chars() {
        match letter {
            ' ' | '/' | '*' | '-' | '_' | '.' | ':' => safe.push(letter),
            letter if letter.is_alphanumeric() => safe.push(letter),
            letter => safe += &format!("#{};", u32::from(letter)),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::processes::tests::studio;

    #[test]
    fn what_one_process_sends_another_is_one_arrow() {
        assert_eq!(
            text(&studio()),
            "flowchart LR
    n0[\"program x0123456\"]
    n1[\"brush-main\"]
    n2[\"paint<br/>answers paint/frame\"]
    n3[\"launcher<br/>answers command/rig\"]
    n4[\"ui\"]
    n0 -->|\"stylus/x/sample 200/s\"| n1
    n0 -->|\"stylus/x/sample 200/s\"| n4
    n1 -->|\"brush/main/state\"| n2
    n1 -->|\"brush/main/state\"| n4
    n2 -->|\"scene\"| n0
    n2 -->|\"paint/consumed 1.0/s\"| n1
    n2 -->|\"scene\"| n3
    n2 -->|\"scene\"| n4
    n4 -->|\"stylus/mouse/sample\"| n1
"
        );
    }

    #[test]
    fn no_topic_ends_a_label() {
        assert_eq!(escaped("a\"]b"), "a#34;#93;b");
    }
}
