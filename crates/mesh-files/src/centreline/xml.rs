//! Parses the elements of VTK's XML files, within limits that the files of all programs satisfy.
//!
//! The time is proportional to the length of the file: namespaces are not resolved, and nesting,
//! repetition and attributes are bounded.

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

/// The maximum nesting of elements. VTK's files have 7 levels.
const MOST_LEVELS: usize = 32;
/// The maximum number of attributes of an element. VTK writes up to 10.
const MOST_ATTRIBUTES: usize = 64;
/// The maximum number of elements of a file. VTK writes about 10 for each piece.
const MOST_ELEMENTS: usize = 1 << 17;

/// An element with its own text.
#[derive(Default)]
pub struct Element {
    pub name: String,
    attributes: Vec<(String, String)>,
    pub text: String,
    pub children: Vec<Element>,
}

impl Element {
    fn new(start: &BytesStart<'_>) -> Result<Self, String> {
        let mut element = Self { name: start.local_name().as_ref().to_owned(), ..Self::default() };
        for attribute in start.attributes().with_checks(false) {
            let attribute = attribute.map_err(|_| "its XML has a damaged attribute")?;
            if element.attributes.len() == MOST_ATTRIBUTES {
                return Err(format!("an element has more than {MOST_ATTRIBUTES} attributes"));
            }
            let (name, value) = (attribute.key.as_ref().to_owned(), attribute.value.into_owned());
            element.attributes.push((name, value));
        }
        Ok(element)
    }

    pub fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(own, _)| own == name).map(|(_, value)| value.as_str())
    }

    pub fn child(&self, name: &str) -> Option<&Element> {
        self.children.iter().find(|child| child.name == name)
    }

    pub fn children<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Element> {
        self.children.iter().filter(move |child| child.name == name)
    }
}

/// Returns the root of a document. If the document is cut off, elements that are open at its end
/// are closed there.
pub fn parse(text: &str, is_cut: bool) -> Result<Element, String> {
    let mut reader = Reader::from_str(text);
    // The outermost element contains the root.
    let mut open = vec![Element::default()];
    let mut count = 0;
    loop {
        let place = reader.buffer_position();
        let event =
            reader.read_event().map_err(|_| format!("its XML is damaged at byte {place}"))?;
        if let Event::Start(start) | Event::Empty(start) = &event {
            count += 1;
            if count > MOST_ELEMENTS {
                return Err(format!("it has more than {MOST_ELEMENTS} elements of XML"));
            }
            if open.len() > MOST_LEVELS {
                return Err(format!("its XML is nested more than {MOST_LEVELS} levels deep"));
            }
            open.push(Element::new(start)?);
        }
        match event {
            Event::Empty(_) | Event::End(_) => close(&mut open),
            Event::Text(own) => {
                if let Some(last) = open.last_mut() {
                    last.text.push_str(&own);
                }
            }
            Event::Eof => break,
            _ => {}
        }
    }
    if open.len() > 1 && !is_cut {
        return Err("its XML ends early".into());
    }
    while open.len() > 1 {
        close(&mut open);
    }
    open.pop().and_then(|mut all| all.children.pop()).ok_or_else(|| "it holds no XML".into())
}

/// Makes the last open element a child of the one before.
fn close(open: &mut Vec<Element>) {
    if open.len() > 1
        && let Some(own) = open.pop()
        && let Some(parent) = open.last_mut()
    {
        parent.children.push(own);
    }
}
