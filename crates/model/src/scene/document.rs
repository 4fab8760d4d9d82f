//! The scene's elements with their positions in the text, and all faults of the XML itself.
//!
//! quick-xml splits the text into tags. This module checks nesting and the names of elements, `tag` checks attributes.
//! Nothing is read twice, so the work is proportional to the length of the text.
use std::{collections::BTreeSet, ops::Range};

use quick_xml::errors::{Error, SyntaxError};
use quick_xml::events::Event;

use super::problem::{MAX_PROBLEMS, Problem, Report, quote};
use super::tag::{self, Tag, is_space, offset};
use super::{grammar, rule::Rule};

/// The elements of the text.
#[derive(Debug, Default)]
pub(super) struct Document<'t> {
    /// The range of `<scene` in the text, in bytes, if there is a scene.
    pub(super) scene: Option<Range<usize>>,
    /// The known children of the scene in document order.
    pub(super) tags: Vec<Tag<'t>>,
    /// Whether the XML is broken, so that elements may have been lost.
    pub(super) is_broken: bool,
    /// The probable intended names of misspelt elements.
    pub(super) intended_names: BTreeSet<&'static str>,
    /// Whether the scene has elements of the rigid-body stub, which are not checked.
    pub(super) has_rigid_bodies: bool,
    /// Whether a root element with another name has been reported.
    pub(super) has_other_root: bool,
}

/// Reads the text, and reports every fault of the XML, of names and of nesting.
pub(super) fn read<'t>(text: &'t str, report: &mut Report) -> Document<'t> {
    let reading = DocumentReader {
        text,
        report,
        document: Document::default(),
        open_elements: Vec::new(),
        root_count: 0,
        is_in_scene: false,
        wrong_end_count: 0,
        has_stray_text: false,
    };
    reading.read_all()
}

/// An element whose closing tag has not been read.
struct OpenElement<'t> {
    name: &'t str,
    span: Range<usize>,
    /// Whether a problem inside the element has been reported.
    is_reported: bool,
}

struct DocumentReader<'t, 'r> {
    text: &'t str,
    report: &'r mut Report,
    document: Document<'t>,
    open_elements: Vec<OpenElement<'t>>,
    root_count: usize,
    is_in_scene: bool,
    wrong_end_count: usize,
    /// Whether the last item was stray text that has been reported.
    has_stray_text: bool,
}

impl<'t> DocumentReader<'t, '_> {
    fn read_all(mut self) -> Document<'t> {
        // The reader drops a byte order mark without counting it.
        let skipped = if self.text.starts_with('\u{feff}') { 3 } else { 0 };
        let mut reader = quick_xml::Reader::from_str(&self.text[skipped..]);
        let config = reader.config_mut();
        // Nesting is checked here, where the place of the opening tag is known.
        config.check_end_names = false;
        config.allow_unmatched_ends = true;
        config.allow_dangling_amp = true;
        loop {
            let position = |offset: u64| usize::try_from(offset).unwrap_or(usize::MAX) + skipped;
            let from = position(reader.buffer_position());
            let event = reader.read_event();
            let span = from..position(reader.buffer_position());
            let was_stray = std::mem::take(&mut self.has_stray_text);
            match event {
                Ok(Event::Eof) => break,
                Ok(Event::Start(_)) => self.start_element(span, true),
                Ok(Event::Empty(_)) => self.start_element(span, false),
                // Enough problems are reported, and the search for an intended name costs time.
                Ok(Event::End(_)) if self.wrong_end_count > MAX_PROBLEMS => break,
                Ok(Event::End(_)) => self.end_element(span),
                Ok(Event::Text(_)) if self.text[span.clone()].trim_ascii().is_empty() => {
                    self.has_stray_text = was_stray
                }
                Ok(Event::Text(_) | Event::CData(_) | Event::GeneralRef(_)) => self.report_stray_text(span, was_stray),
                Ok(Event::DocType(_)) => self.read_document_type(span),
                Ok(Event::Comment(_) | Event::PI(_) | Event::Decl(_)) => {}
                Err(error) => {
                    self.document.is_broken = true;
                    let at = position(reader.error_position()).min(self.text.len());
                    self.report_syntax(at, &error);
                    if !matches!(error, Error::IllFormed(_)) {
                        break;
                    }
                }
            }
        }
        self.finish();
        self.document
    }

    /// Reports an element that is still open at the end. Only the innermost is reported, because the others may follow
    /// from it.
    fn finish(&mut self) {
        if let Some(open) = self.open_elements.last() {
            if !self.document.is_broken {
                self.report.add_error(|| {
                    Problem::from_element(open.name, &open.span, format!("`<{}>` is never closed", quote(open.name)))
                        .with_help(format!("end it with `/>` or with `</{}>`", quote(open.name)))
                        .in_markup()
                });
            }
            self.document.is_broken = true;
        }
    }

    fn report_syntax(&mut self, at: usize, error: &Error) {
        let (message, help) = match error {
            Error::Syntax(syntax) => describe_syntax_error(*syntax),
            other => (other.to_string(), None),
        };
        let first = self.text.get(at..).and_then(|rest| rest.chars().next());
        let end = at + first.map_or(0, char::len_utf8);
        self.report.add_error(|| Problem::new(at..end, message).with_optional_help(help).in_markup());
    }

    fn read_document_type(&mut self, span: Range<usize>) {
        let declares = self.text[span.clone()].contains('[');
        if declares {
            self.report.add_error(|| {
                Problem::new(span, "the document type contains declarations, and the original ignores them")
                    .with_help("replace the entities by their text, and remove the document type")
            });
        }
    }

    fn report_stray_text(&mut self, span: Range<usize>, reported: bool) {
        self.has_stray_text = true;
        if reported {
            return;
        }
        let text = self.text[span.clone()].trim_ascii();
        let outside = self.open_elements.is_empty();
        let at = offset(self.text, text);
        self.report.add_error(|| {
            let place = if outside { "outside the scene" } else { "between the elements" };
            Problem::new(at..at + text.len(), format!("text {place}: `{}`", quote(text)))
                .with_help("only elements count here; remove it or make it a comment, `<!-- ... -->`")
        });
    }

    fn start_element(&mut self, span: Range<usize>, opens: bool) {
        let inner = &self.text[span.start + 1..span.end - if opens { 1 } else { 2 }];
        let name_length = inner.bytes().position(is_space).unwrap_or(inner.len());
        let name = &inner[..name_length];
        if name.is_empty() {
            self.document.is_broken = true;
            self.report.add_error(|| Problem::new(span.clone(), "no element name after `<`").in_markup());
            return;
        }
        let name_span = span.start..span.start + 1 + name_length;
        self.warn_joined_name(inner, name, &name_span);
        match self.open_elements.len() {
            0 => self.read_root(name, inner, &name_span),
            1 if self.is_in_scene => self.read_child(name, inner, &name_span),
            2.. if self.is_in_scene => self.report_nested(name, &name_span),
            _ => {}
        }
        // `/ >` is reported as an attribute, but was meant to end the element.
        if opens && !inner.trim_ascii_end().ends_with('/') {
            self.open_elements.push(OpenElement { name, span: name_span, is_reported: false });
        } else if self.open_elements.is_empty() {
            self.is_in_scene = false;
        }
    }

    /// Reports a name that is followed by only a line feed. The original joins the lines, and with them the name and
    /// the first attribute.
    fn warn_joined_name(&mut self, inner: &str, name: &str, span: &Range<usize>) {
        let behind = inner[name.len()..].trim_start_matches('\n');
        let glued = behind.len() < inner.len() - name.len() && behind.bytes().next().is_some_and(|b| !is_space(b));
        if glued && behind != "/" {
            self.report.add_error(|| {
                Problem::from_element(
                    name,
                    span,
                    format!("only a line break between `{}` and its first attribute", quote(name)),
                )
                .with_help("the original joins the lines and then misses the element; put a space before the attribute")
            });
        }
    }

    fn read_root(&mut self, name: &'t str, inner: &'t str, span: &Range<usize>) {
        self.root_count += 1;
        let similar = grammar::find_closest(name, ["scene"].into_iter()).is_some();
        self.is_in_scene = self.document.scene.is_none() && (name == "scene" || (similar && self.root_count == 1));
        if self.is_in_scene {
            self.document.scene = Some(span.clone());
        }
        if name != "scene" {
            self.document.has_other_root = true;
            let (message, help) = match (self.is_in_scene, self.document.scene.is_some()) {
                (true, _) => (format!("the root element is `{}`, not `scene`", quote(name)), "did you mean `scene`?"),
                (_, true) => (format!("a second root element `{}`", quote(name)), "only the first `scene` counts"),
                (_, false) => (
                    format!("the root element is `{}`, not `scene`", quote(name)),
                    "put all elements into one element `scene`",
                ),
            };
            self.report.add_error(|| Problem::from_element(name, span, message).with_help(help));
        } else if !self.is_in_scene {
            self.report.add_error(|| {
                Problem::from_element(name, span, "a second `scene`")
                    .with_help("only the first one counts; move its elements there or to another file")
            });
        }
        static SCENE_RULE: Rule = Rule { name: "scene", attributes: &[] };
        if self.is_in_scene {
            tag::read(self.text, &SCENE_RULE, inner, span.clone(), self.report);
        }
    }

    fn report_nested(&mut self, name: &str, span: &Range<usize>) {
        let Some(parent) = self.open_elements.get_mut(1) else { return };
        if std::mem::replace(&mut parent.is_reported, true) {
            return;
        }
        self.document.is_broken = true;
        self.report.add_error(|| {
            let (inner, outer) = (quote(name), quote(parent.name));
            Problem::from_element(name, span, format!("`{inner}` inside `{outer}`"))
                .with_help(format!("only elements directly in `scene` count; is the end of `{outer}` missing?"))
                .in_markup()
        });
    }

    fn read_child(&mut self, name: &'t str, inner: &'t str, span: &Range<usize>) {
        if let Some(rule) = grammar::rule(name) {
            if rule.name.starts_with("rigidbody") {
                self.document.has_rigid_bodies = true;
                return;
            }
            let tag = tag::read(self.text, rule, inner, span.clone(), self.report);
            self.document.tags.push(tag);
            return;
        }
        // The search for a similar name takes time, so only displayed problems get a suggestion.
        let intended_names = &mut self.document.intended_names;
        self.report.add_error(|| {
            let similar = grammar::similar_element(name);
            intended_names.extend(similar);
            Problem::from_element(name, span, format!("unknown element `{}`", quote(name))).with_help(
                similar.map_or_else(
                    || "the original ignores it silently".to_owned(),
                    |similar| format!("did you mean `{similar}`?"),
                ),
            )
        });
    }

    fn end_element(&mut self, span: Range<usize>) {
        let name = self.text[span.start + 2..span.end - 1].trim_ascii_end();
        // The maximum depth of nesting. Without a limit, a file of wrong closing tags would take too long.
        const MAX_DEPTH: usize = 64;
        let elements_above = self.open_elements.iter().rev().take(MAX_DEPTH).position(|open| open.name == name);
        match (elements_above, self.open_elements.last()) {
            (Some(0), _) => {}
            (Some(above), Some(last)) => {
                self.document.is_broken = true;
                let nested = self.is_in_scene && self.open_elements.get(1).is_some_and(|open| open.is_reported);
                if !nested {
                    self.report.add_error(|| {
                        Problem::from_element(last.name, &last.span, format!("`<{}>` is not closed", quote(last.name)))
                            .with_help(format!("end it with `/>` or with `</{}>`", quote(last.name)))
                            .in_markup()
                    });
                }
                self.open_elements.truncate(self.open_elements.len() - above);
            }
            (None, last) => {
                self.document.is_broken = true;
                self.wrong_end_count += 1;
                let slip = last.is_some_and(|open| grammar::find_closest(name, [open.name].into_iter()).is_some());
                self.report.add_error(|| {
                    let help = last.map(|open| format!("open is `<{}>`", quote(open.name)));
                    Problem::from_element(name, &span, format!("`</{}>` closes nothing", quote(name)))
                        .with_optional_help(help)
                        .in_markup()
                });
                if !slip {
                    return;
                }
            }
            (Some(_), None) => return,
        }
        self.open_elements.pop();
        self.is_in_scene &= !self.open_elements.is_empty();
    }
}

fn describe_syntax_error(error: SyntaxError) -> (String, Option<String>) {
    let (message, help) = match error {
        SyntaxError::InvalidBangMarkup => ("`<!` does not start a known construct", "`<!-- ... -->`"),
        SyntaxError::UnclosedPI | SyntaxError::UnclosedXmlDecl => ("`<?` without `?>`", "end it with `?>`"),
        SyntaxError::UnclosedComment => ("a comment without end", "end it with `-->`"),
        SyntaxError::UnclosedDoctype => ("a document type without its end", "end it with `>`"),
        SyntaxError::UnclosedCData => ("a CDATA section without its end", "end it with `]]>`"),
        SyntaxError::UnclosedTag => ("a tag without end", "end it with `>` or `/>`"),
        SyntaxError::UnclosedSingleQuotedAttributeValue | SyntaxError::UnclosedDoubleQuotedAttributeValue => {
            ("a quotation mark is missing in this tag or after it", "close every value")
        }
    };
    (message.to_owned(), Some(help.to_owned()))
}
