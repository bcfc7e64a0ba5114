//! The XML encoding of X3D (ISO/IEC 19776-1): elements and their attributes.

use crate::FormatError;
use crate::x3d_nodes::{Node, Route, Scene, is_kept};
use crate::xml::Xml;
use roxmltree::Node as Element;

pub(crate) fn read(text: &str) -> Result<Scene, FormatError> {
    let xml = Xml::read(text, "export the motion again")?;
    let mut scene = Scene::default();
    // Elements still to be read, each with the node that contains it.
    let mut waiting = vec![(xml.root(), None)];
    while let Some((element, within)) = waiting.pop() {
        if element.tag_name().name() == "ProtoDeclare" {
            continue;
        }
        let node = take_up(&mut scene, element, (within, xml.line(element)));
        let inside = element.children().filter(Element::is_element).rev();
        waiting.extend(inside.map(|child| (child, node)));
    }
    Ok(scene)
}

/// Adds an element inside the node `within` to the scene; returns the index of the new node, if the element
/// is a node.
fn take_up(
    scene: &mut Scene,
    element: Element<'_, '_>,
    (within, line): (Option<usize>, usize),
) -> Option<usize> {
    let given = |name: &str| element.attribute(name).unwrap_or_default();
    match element.tag_name().name() {
        "ROUTE" => {
            let to = (given("toNode"), given("toField"));
            let route = Route::new(given("fromNode"), to, line);
            scene.routes.push(route);
            None
        }
        "fieldValue" => {
            // A field of the prototype instance that contains this element.
            let field = given("name");
            if let Some(node) = within.filter(|_| is_kept(field)) {
                let words = words(given("value"));
                scene.nodes[node].fields.insert(field.to_owned(), words);
            }
            None
        }
        kind => {
            let is_instance = kind == "ProtoInstance";
            let kept = element.attributes().filter(|field| {
                // The attribute `name` of an instance is the name of its prototype.
                is_kept(field.name()) && !(is_instance && field.name() == "name")
            });
            scene.nodes.push(Node {
                kind: if is_instance { given("name") } else { kind }.to_owned(),
                name: given("DEF").to_owned(),
                line,
                fields: kept
                    .map(|field| (field.name().to_owned(), words(field.value())))
                    .collect(),
            });
            Some(scene.nodes.len() - 1)
        }
    }
}

fn words(value: &str) -> Vec<String> {
    let words = value.split(|c: char| c.is_whitespace() || c == ',');
    words.filter(|w| !w.is_empty()).map(str::to_owned).collect()
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
            ("<X3D>\n<Scene>", "line 2: the file ends too early"),
            ("<X3D></X3D>\n</Scene>", "line 2"),
            (
                "<X3D>\n<Scene></X3D>",
                "line 2: expected 'Scene' tag, not 'X3D'",
            ),
            ("<X3D>\n<Scene a='", "line 2: the file ends too early"),
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

    #[test]
    fn entities_of_the_file_and_letters_by_number_are_followed() {
        let text = "<!DOCTYPE X3D [ <!ENTITY hip \"l_hip\"> ]>\n\
            <X3D><Scene><!-- <HAnimJoint DEF='no'/> --><![CDATA[ <HAnimJoint DEF='no'/> ]]>\n\
            <HAnimJoint DEF='a' name='&hip;' center=\"&#48; 1&#x20;2\"/></Scene></X3D>";
        let scene = read(text).unwrap();
        let joint = scene.named("a").unwrap();
        assert_eq!((joint.line, joint.text("name")), (3, Some("l_hip")));
        assert_eq!(joint.numbers("center").unwrap(), [0.0, 1.0, 2.0]);
        assert!(scene.named("no").is_none());
        let bomb = text.replace("\"l_hip\"", "\"&hip;&hip;\"");
        assert!(read(&bomb).unwrap_err().to_string().contains("entity"));
    }

    #[test]
    fn what_is_not_well_formed_is_refused_and_not_guessed() {
        for (attribute, what) in [
            ("DEF='a' DEF='b'", "DEF"),
            ("DEF=a", "expected"),
            ("DEF='&none;'", "none"),
        ] {
            let text = format!("<X3D>\n<HAnimJoint {attribute}/></X3D>");
            let error = read(&text).unwrap_err();
            assert_eq!(error.place, "line 2");
            assert!(error.what.contains(what), "{error}");
        }
    }
}
