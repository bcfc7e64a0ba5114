//! The XML encoding of X3D (ISO/IEC 19776-1): tags and their attributes.

use crate::FormatError;
use crate::x3d_nodes::{Node, Route, Scene, ends_within, is_kept, not_open};
use std::collections::BTreeMap;

/// What is being read.
#[derive(Default)]
struct Reader {
    scene: Scene,
    /// Line and name of the elements that are open, and their nodes.
    open: Vec<(usize, String, Option<usize>)>,
    /// Elements open within prototypes and they themselves.
    prototypes: usize,
}

pub(crate) fn read(text: &str) -> Result<Scene, FormatError> {
    let mut reader = Reader::default();
    let (mut rest, mut line) = (text, 1);
    let lines = |part: &str| part.matches('\n').count();
    while let Some(start) = rest.find('<') {
        line += lines(&rest[..start]);
        rest = &rest[start..];
        let length = length_of(rest).ok_or_else(|| ends_within(format!("line {line}, a tag")))?;
        let (tag, after) = rest.split_at(length);
        if let Some(closed) = tag.strip_prefix("</") {
            reader.close(closed.trim_end_matches('>').trim(), line)?;
        } else if !tag.starts_with("<!") && !tag.starts_with("<?") {
            reader.open(tag, line);
        }
        line += lines(tag);
        rest = after;
    }
    match reader.open.last() {
        None => Ok(reader.scene),
        Some((line, name, _)) => Err(ends_within(format!("line {line}, {name}"))),
    }
}

impl Reader {
    fn open(&mut self, tag: &str, line: usize) {
        let inner = tag[1..].trim_end_matches('>');
        let is_empty = inner.ends_with('/');
        let inner = inner.trim_end_matches('/');
        let kind: String = inner.chars().take_while(|c| !c.is_whitespace()).collect();
        let node = match self.prototypes > 0 || kind == "ProtoDeclare" {
            true => None,
            false => self.read(&kind, attributes(&inner[kind.len()..]), line),
        };
        if is_empty {
            return;
        }
        if self.prototypes > 0 || kind == "ProtoDeclare" {
            self.prototypes += 1;
        }
        self.open.push((line, kind, node));
    }

    fn close(&mut self, name: &str, line: usize) -> Result<(), FormatError> {
        match self.open.pop() {
            Some((_, open, _)) if open == name => {
                self.prototypes = self.prototypes.saturating_sub(1);
                Ok(())
            }
            Some((from, open, _)) => Err(FormatError::new(
                format!("line {line}"),
                format!("</{name}> closes <{open}> of line {from}"),
                "export the motion again",
            )),
            None => Err(not_open(line)),
        }
    }

    /// Takes an element up; the number of its node, if it is one.
    fn read(
        &mut self,
        kind: &str,
        mut attributes: BTreeMap<String, String>,
        line: usize,
    ) -> Option<usize> {
        let mut take = |name: &str| attributes.remove(name).unwrap_or_default();
        match kind {
            "ROUTE" => {
                let to = (take("toNode"), take("toField"));
                let to = (to.0.as_str(), to.1.as_str());
                let route = Route::new(&take("fromNode"), to, line);
                self.scene.routes.push(route);
                return None;
            }
            "fieldValue" => {
                // A field of the instance of a prototype that this stands in.
                let (field, value) = (take("name"), take("value"));
                let instance = self.open.last().and_then(|open| open.2);
                if let Some(node) = instance.filter(|_| is_kept(&field)) {
                    self.scene.nodes[node].fields.insert(field, words(&value));
                }
                return None;
            }
            _ => {}
        }
        let name = take("DEF");
        let kind = match kind {
            "ProtoInstance" => take("name"),
            _ => kind.to_owned(),
        };
        let kept = attributes.iter().filter(|field| is_kept(field.0));
        self.scene.nodes.push(Node {
            kind,
            name,
            line,
            fields: kept.map(|(k, v)| (k.clone(), words(v))).collect(),
        });
        Some(self.scene.nodes.len() - 1)
    }
}

fn words(value: &str) -> Vec<String> {
    let words = value.split(|c: char| c.is_whitespace() || c == ',');
    words.filter(|w| !w.is_empty()).map(str::to_owned).collect()
}

/// Length of what begins with `<`: a comment, a section of text, or a tag, whose values in quotes
/// may hold anything \[bytes\]. Nothing if it does not end.
fn length_of(text: &str) -> Option<usize> {
    let to = |ending: &str| text.find(ending).map(|at| at + ending.len());
    if text.starts_with("<!--") {
        return to("-->");
    }
    if text.starts_with("<![CDATA[") {
        return to("]]>");
    }
    let mut quote = None;
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        match (quote, c) {
            (Some(open), c) if c == open => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            // A document type may hold declarations of its own.
            (None, '[') => depth += 1,
            (None, ']') => depth -= 1,
            (None, '>') if depth <= 0 => return Some(at + 1),
            _ => {}
        }
    }
    None
}

/// Attributes of a tag: `name='value'` or `name="value"`.
fn attributes(mut text: &str) -> BTreeMap<String, String> {
    let mut all = BTreeMap::new();
    while let Some(equals) = text.find('=') {
        let name = text[..equals].trim();
        let value = text[equals + 1..].trim_start();
        let Some(quote) = value.chars().next().filter(|c| matches!(c, '"' | '\'')) else {
            break;
        };
        let Some(end) = value[1..].find(quote) else {
            break;
        };
        let name = name.rsplit(char::is_whitespace).next().unwrap_or(name);
        all.insert(name.to_owned(), unescaped(&value[1..=end]));
        text = &value[end + 2..];
    }
    all
}

/// A value with the five letters that XML names.
fn unescaped(value: &str) -> String {
    let names = [
        ("&lt;", "<"),
        ("&gt;", ">"),
        ("&quot;", "\""),
        ("&apos;", "'"),
        ("&amp;", "&"),
    ];
    let replaced = |text: String, (name, letter): (&str, &str)| text.replace(name, letter);
    names.into_iter().fold(value.to_owned(), replaced)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_comments_and_scripts_may_hold_angle_brackets() {
        let text = "<?xml version=\"1.0\"?>\n\
            <!DOCTYPE X3D PUBLIC \"ISO//X3D\" \"a.dtd\" [ <!ENTITY a \"b\"> ]>\n\
            <X3D><head><meta content='a > b &amp; c' name='x'/><!-- <Joint> --></head>\n\
            <Scene><Script><![CDATA[ if (a < b) { c > d } ]]></Script>\n\
            <HAnimJoint DEF=\"it's\"\n name='l_hip' center='0 1, 2'/></Scene></X3D>";
        let scene = read(text).unwrap();
        let joint = scene.named("it's").unwrap();
        assert_eq!((joint.line, joint.text("name")), (5, Some("l_hip")));
        assert_eq!(joint.numbers("center").unwrap(), [0.0, 1.0, 2.0]);
        assert_eq!(scene.named("").unwrap().kind, "X3D");
    }

    #[test]
    fn prototypes_are_left_out_and_their_instances_taken() {
        let text = "<X3D><Scene><ProtoDeclare name='Joint'><ProtoBody>\n\
            <Transform DEF='inner'><IS><connect nodeField='center' protoField='center'/></IS></Transform>\n\
            <ROUTE fromNode='inner' fromField='a' toNode='inner' toField='b'/></ProtoBody></ProtoDeclare>\n\
            <ProtoInstance name='Joint' DEF='hip'><fieldValue name='name' value='l_hip'/>\n\
            <fieldValue name='center' value='0 1 2'/></ProtoInstance></Scene></X3D>";
        let scene = read(text).unwrap();
        assert!(scene.routes.is_empty() && scene.named("inner").is_none());
        let hip = scene.named("hip").unwrap();
        assert_eq!(
            (hip.kind.as_str(), hip.text("name")),
            ("Joint", Some("l_hip"))
        );
        assert_eq!(hip.numbers("center").unwrap(), [0.0, 1.0, 2.0]);
    }

    #[test]
    fn elements_left_open_or_closed_twice_are_refused() {
        for (text, what) in [
            ("<X3D>\n<Scene>", "line 2, Scene"),
            ("<X3D></X3D>\n</Scene>", "line 2"),
            ("<X3D>\n<Scene></X3D>", "</X3D> closes <Scene>"),
            ("<X3D>\n<Scene a='", "line 2, a tag"),
        ] {
            let error = read(text).unwrap_err().to_string();
            assert!(error.contains(what), "{text}: {error}");
        }
    }

    #[test]
    fn long_files_are_read_in_time_that_grows_with_their_length() {
        let many = "<Transform/>\n".repeat(200_000);
        let started = std::time::Instant::now();
        let scene = read(&format!("<X3D>\n{many}</X3D>")).unwrap();
        assert_eq!(scene.nodes.last().unwrap().line, 200_001);
        assert!(
            started.elapsed().as_secs_f64() < 10.0,
            "{:?}",
            started.elapsed()
        );
    }
}
