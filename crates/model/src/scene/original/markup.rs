//! The original's XML: elements of the first `scene` root, from text whose lines have been joined.
//!
//! This is a small in-situ parser without validation (scene-format.md 1.4). A closing tag closes the innermost open
//! element, text and comments are skipped, and only the children of the scene are kept.
use crate::scene::tag::is_space;
use std::borrow::Cow;

/// A child of the scene.
#[derive(Debug)]
pub(super) struct Element<'t> {
    pub(super) name: &'t [u8],
    attributes: Vec<(&'t [u8], Cow<'t, [u8]>)>,
}

impl Element<'_> {
    /// Returns the text of an attribute. If several have the same name, the first counts. A NUL (from `&#0;`) ends the
    /// text.
    pub(super) fn attribute(&self, name: &str) -> Option<&[u8]> {
        let (_, value) = self.attributes.iter().find(|(found, _)| *found == name.as_bytes())?;
        Some(value.split(|&byte| byte == 0).next().unwrap_or_default())
    }
}

/// Joins the lines of a file as the original does: line feeds vanish, and a NUL ends the text.
pub(super) fn join_lines(bytes: &[u8]) -> Vec<u8> {
    // The original searches for the NUL after joining; the order makes no difference.
    let text = bytes.split(|&byte| byte == 0).next().unwrap_or_default();
    text.split(|&byte| byte == b'\n').collect::<Vec<_>>().concat()
}

/// Reads the children of the first root named `scene`. Returns `None` if there is no such root. The error is the text
/// of the original's exception.
pub(super) fn parse(text: &[u8]) -> Result<Option<Vec<Element<'_>>>, &'static str> {
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    let mut cursor = Cursor { text, offset: 0 };
    let mut children: Option<Vec<Element<'_>>> = None;
    let mut inside_scene = false;
    let mut depth = 0_usize;
    loop {
        cursor.skip(is_space);
        match (cursor.peek(0), depth) {
            (0, 0) => return Ok(children),
            (0, _) => return Err(UNEXPECTED_END),
            (b'<', 1..) if cursor.peek(1) == b'/' => {
                cursor.expect_close()?;
                depth -= 1;
            }
            (b'<', _) => {
                cursor.offset += 1;
                let Some((element, opens)) = cursor.read_node()? else { continue };
                match depth {
                    0 => {
                        inside_scene = children.is_none() && element.name == b"scene";
                        if inside_scene {
                            children = Some(Vec::new());
                        }
                    }
                    1 if inside_scene => children.get_or_insert_default().push(element),
                    _ => {}
                }
                depth += usize::from(opens);
            }
            (_, 0) => return Err("expected <"),
            // Character references in text are translated as well, although no code reads the result.
            _ => drop(cursor.read_value(b'<')?),
        }
    }
}

const UNEXPECTED_END: &str = "unexpected end of data";
const EXPECTED_CLOSE: &str = "expected >";

fn is_element_name(byte: u8) -> bool {
    !is_space(byte) && !matches!(byte, b'/' | b'>' | b'?' | 0)
}

fn is_attribute_name(byte: u8) -> bool {
    !is_space(byte) && !matches!(byte, b'/' | b'<' | b'>' | b'=' | b'?' | b'!' | 0)
}

struct Cursor<'t> {
    text: &'t [u8],
    offset: usize,
}

impl<'t> Cursor<'t> {
    /// Returns the byte at distance `ahead` from the current position, or 0 after the end. The text itself contains no
    /// NUL.
    fn peek(&self, ahead: usize) -> u8 {
        self.text.get(self.offset + ahead).copied().unwrap_or(0)
    }

    /// Returns the rest of the text, which is empty after the end.
    fn rest(&self) -> &'t [u8] {
        self.text.get(self.offset..).unwrap_or_default()
    }

    fn skip(&mut self, is_skipped: impl Fn(u8) -> bool) -> &'t [u8] {
        let rest = self.rest();
        let length = rest.iter().position(|&byte| !is_skipped(byte)).unwrap_or(rest.len());
        self.offset += length;
        &rest[..length]
    }

    /// Advances past the next `end`.
    fn skip_past(&mut self, end: &[u8]) -> Result<(), &'static str> {
        let found = self.rest().windows(end.len()).position(|window| window == end).ok_or(UNEXPECTED_END)?;
        self.offset += found + end.len();
        Ok(())
    }

    fn expect_close(&mut self) -> Result<(), &'static str> {
        self.offset += 2;
        self.skip(is_element_name);
        self.skip(is_space);
        self.expect(b'>', EXPECTED_CLOSE)
    }

    /// Advances past `byte`.
    fn expect(&mut self, byte: u8, otherwise: &'static str) -> Result<(), &'static str> {
        if self.peek(0) != byte {
            return Err(otherwise);
        }
        self.offset += 1;
        Ok(())
    }

    /// Reads the node after a `<` that does not begin a closing tag. Returns an element and whether it has contents, or
    /// `None` for a node that is ignored.
    fn read_node(&mut self) -> Result<Option<(Element<'t>, bool)>, &'static str> {
        match self.peek(0) {
            b'?' => {
                self.offset += 1;
                self.skip_past(b"?>").map(|()| None)
            }
            b'!' => self.skip_declaration().map(|()| None),
            _ => self.read_element().map(Some),
        }
    }

    fn skip_declaration(&mut self) -> Result<(), &'static str> {
        let rest = self.rest();
        if rest.starts_with(b"!--") {
            self.offset += 3;
            self.skip_past(b"-->")
        } else if rest.starts_with(b"![CDATA[") {
            self.offset += 8;
            self.skip_past(b"]]>")
        } else if rest.starts_with(b"!DOCTYPE") && is_space(self.peek(8)) {
            self.offset += 9;
            self.skip_document_type()
        } else {
            self.skip_past(b">")
        }
    }

    /// Advances past the next `>` that is not in brackets.
    fn skip_document_type(&mut self) -> Result<(), &'static str> {
        let mut depth = 0_usize;
        loop {
            match self.peek(0) {
                0 => return Err(UNEXPECTED_END),
                b'[' => depth += 1,
                b']' => depth = depth.saturating_sub(1),
                b'>' if depth == 0 => break,
                _ => {}
            }
            self.offset += 1;
        }
        self.offset += 1;
        Ok(())
    }

    fn read_element(&mut self) -> Result<(Element<'t>, bool), &'static str> {
        let name = self.skip(is_element_name);
        if name.is_empty() {
            return Err("expected element name");
        }
        self.skip(is_space);
        let mut attributes = Vec::new();
        while is_attribute_name(self.peek(0)) {
            let name = self.skip(is_attribute_name);
            self.skip(is_space);
            self.expect(b'=', "expected =")?;
            self.skip(is_space);
            let quote = self.peek(0);
            if quote != b'\'' && quote != b'"' {
                return Err("expected ' or \"");
            }
            self.offset += 1;
            let value = self.read_value(quote)?;
            self.expect(quote, "expected ' or \"")?;
            self.skip(is_space);
            attributes.push((name, value));
        }
        let opens = self.expect(b'/', EXPECTED_CLOSE).is_err();
        self.expect(b'>', EXPECTED_CLOSE)?;
        Ok((Element { name, attributes }, opens))
    }

    /// Reads text up to `end` (not included) or to the end of the text, with its references translated.
    fn read_value(&mut self, end: u8) -> Result<Cow<'t, [u8]>, &'static str> {
        let plain = self.skip(|byte| byte != end && byte != b'&');
        if self.peek(0) != b'&' {
            return Ok(Cow::Borrowed(plain));
        }
        let mut value = plain.to_vec();
        loop {
            match self.peek(0) {
                b'&' => self.translate_reference(&mut value)?,
                byte if byte == end || byte == 0 => return Ok(Cow::Owned(value)),
                byte => {
                    value.push(byte);
                    self.offset += 1;
                }
            }
        }
    }

    /// Translates one `&...;`; an unknown name is copied unchanged.
    fn translate_reference(&mut self, value: &mut Vec<u8>) -> Result<(), &'static str> {
        const NAMED_ENTITIES: [(&[u8], u8); 5] =
            [(b"&amp;", b'&'), (b"&apos;", b'\''), (b"&quot;", b'"'), (b"&gt;", b'>'), (b"&lt;", b'<')];
        let rest = self.rest();
        if let Some((name, byte)) = NAMED_ENTITIES.iter().find(|(name, _)| rest.starts_with(name)) {
            value.push(*byte);
            self.offset += name.len();
            return Ok(());
        }
        let base = match (self.peek(1), self.peek(2)) {
            (b'#', b'x') => 16_u64,
            (b'#', _) => 10,
            _ => {
                value.push(b'&');
                self.offset += 1;
                return Ok(());
            }
        };
        self.offset += if base == 16 { 3 } else { 2 };
        // Digits up to F count in both bases, and the number wraps: `&#1A;` is 20.
        let mut code = 0_u64;
        while let Some(digit) = char::from(self.peek(0)).to_digit(16) {
            code = code.wrapping_mul(base).wrapping_add(u64::from(digit));
            self.offset += 1;
        }
        encode_utf8(code, value)?;
        self.expect(b';', "expected ;")
    }
}

/// Writes the UTF-8 form of a code, surrogates included.
fn encode_utf8(code: u64, value: &mut Vec<u8>) -> Result<(), &'static str> {
    let code = u32::try_from(code).ok().filter(|&code| code < 0x11_0000).ok_or("invalid numeric character entity")?;
    let six = |shift: u32| ((code >> shift) & 0x3f) as u8 | 0x80;
    match code {
        0..0x80 => value.push(code as u8),
        0x80..0x800 => value.extend([(code >> 6) as u8 | 0xc0, six(0)]),
        0x800..0x1_0000 => value.extend([(code >> 12) as u8 | 0xe0, six(6), six(0)]),
        _ => value.extend([(code >> 18) as u8 | 0xf0, six(12), six(6), six(0)]),
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str) -> Result<Option<Vec<String>>, &'static str> {
        let text = join_lines(text.as_bytes());
        let children = parse(&text)?;
        Ok(children.map(|all| all.iter().map(|element| String::from_utf8_lossy(element.name).into_owned()).collect()))
    }

    fn value(text: &str) -> Vec<u8> {
        let text = join_lines(text.as_bytes());
        let children = parse(&text).expect("parses").expect("has a scene");
        children[0].attribute("a").expect("has the attribute").to_vec()
    }

    #[test]
    fn only_children_of_the_first_scene_are_kept() {
        let text = "<x><scene><n/></scene></x><scene><a><deep/></a><b/></scene><scene><c/></scene>";
        assert_eq!(names(text), Ok(Some(vec!["a".into(), "b".into()])));
    }

    #[test]
    fn closing_tags_close_whatever_is_open() {
        assert_eq!(names("<scene><a></q><b></r></s>"), Ok(Some(vec!["a".into(), "b".into()])));
    }

    #[test]
    fn a_line_feed_after_a_name_glues_it_to_the_attribute() {
        assert_eq!(names("<scene><edge\ni='0' j='1'/></scene>"), Ok(Some(vec!["edgei='0'".into()])));
        assert_eq!(names("<scene><edge\ni = '0'/></scene>"), Err(EXPECTED_CLOSE));
        assert_eq!(names("<scene><edge\r\ni='0'/></scene>"), Ok(Some(vec!["edge".into()])));
    }

    #[test]
    fn nodes_that_are_not_elements_are_skipped() {
        let text = "\u{feff}<?xml version='1.0'?><!DOCTYPE scene [ <!ELEMENT [a] (b)> ]><!-- <scene> -->\
                    <scene>text<![CDATA[<b/>]]><!whatever><?pi?><a/></scene>";
        assert_eq!(names(text), Ok(Some(vec!["a".into()])));
    }

    #[test]
    fn no_scene_is_not_a_syntax_error() {
        assert_eq!(names(""), Ok(None));
        assert_eq!(names(" \r\n\t"), Ok(None));
        assert_eq!(names("<Scene/>"), Ok(None));
        assert_eq!(names("\0<scene/>"), Ok(None));
    }

    #[test]
    fn attributes_need_no_white_space_and_the_first_counts() {
        assert_eq!(value("<scene><e a='1'\na=\"2\"b='3'/></scene>"), b"1");
        assert_eq!(value("<scene><e a = '1\n2'/></scene>"), b"12");
    }

    #[test]
    fn references_are_translated() {
        assert_eq!(value("<scene><e a='&lt;&gt;&amp;&apos;&quot;'/></scene>"), b"<>&'\"");
        let numbers = value("<scene><e a='&#65;&#x41;&#1A;&#xe9;&#x20AC;&#x1F600;'/></scene>");
        assert_eq!(numbers, "AA\u{14}é€😀".as_bytes());
        assert_eq!(value("<scene><e a='&nbsp; & &amp &'/></scene>"), b"&nbsp; & &amp &");
        assert_eq!(value("<scene><e a='x&#0;y'/></scene>"), b"x");
    }

    #[test]
    fn every_syntax_error_has_the_original_s_words() {
        for (text, error) in [
            ("scene", "expected <"),
            ("<scene/>x", "expected <"),
            ("<scene>", UNEXPECTED_END),
            ("<scene><a/>text", UNEXPECTED_END),
            ("<!--", UNEXPECTED_END),
            ("<!x", UNEXPECTED_END),
            ("<?xml", UNEXPECTED_END),
            ("<!DOCTYPE [", UNEXPECTED_END),
            ("<![CDATA[]]", UNEXPECTED_END),
            ("< scene/>", "expected element name"),
            ("</scene>", "expected element name"),
            ("<scene a/>", "expected ="),
            ("<scene a=1/>", "expected ' or \""),
            ("<scene a='1/>", "expected ' or \""),
            ("<scene / >", EXPECTED_CLOSE),
            ("<scene <a/>", EXPECTED_CLOSE),
            ("<scene></scene", EXPECTED_CLOSE),
            ("<scene a='&#65'/>", "expected ;"),
            ("<scene>&#xZ;</scene>", "expected ;"),
            ("<scene a='&#x110000;'/>", "invalid numeric character entity"),
        ] {
            assert_eq!(names(text), Err(error), "{text}");
        }
    }
}
