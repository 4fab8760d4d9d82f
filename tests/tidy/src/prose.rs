//! Documents and comments for readers: links work, sentences are short, and nouns name things.
use crate::tree::{files, name, root, sources, text};
use std::path::{Path, PathBuf};

/// Readers must read longer sentences twice.
const MOST_WORDS: usize = 30;

/// Each of four groups of readers must find its commands on one page.
const MOST_WORDS_OF_README: usize = 1_200;

/// A page of `docs` is for one group of readers, who read it in a few minutes.
const MOST_WORDS_OF_PAGE: usize = 1_500;

/// Returns the documents in the top folder, in `docs`, and next to files that need one.
fn documents() -> Vec<PathBuf> {
    let docs = ["docs", "docs/rules", "docs/sandbox", "docs/server"];
    let beside = [".", "assets", "fuzz", "examples/deploy", "examples/traces"];
    documents_in(&docs.into_iter().chain(beside).collect::<Vec<_>>())
}

/// Returns the documents of these folders, without those in `docs/spec`, which describe the original in its own terms.
fn documents_in(folders: &[&str]) -> Vec<PathBuf> {
    let folders = folders.iter().map(|folder| root().join(folder));
    let entries = folders.flat_map(|folder| std::fs::read_dir(folder).expect("a folder"));
    let paths = entries.map(|entry| entry.expect("an entry").path());
    paths.filter(|path| path.extension().is_some_and(|ending| ending == "md")).collect()
}

/// Returns the text without code blocks and tables.
fn paragraphs(text: &str) -> String {
    let mut is_code = false;
    let mut kept = String::new();
    for line in text.lines() {
        if line.starts_with("```") {
            is_code = !is_code;
            kept.push_str(".\n");
        } else if !is_code && !line.starts_with('|') {
            // A heading, a list entry and an empty line end a sentence.
            let starts = line.is_empty() || line.starts_with(['#', '*', '-']);
            kept.push_str(if starts { ".\n" } else { "" });
            kept.push_str(line);
            kept.push('\n');
        }
    }
    kept
}

/// Returns the sentences of a text, each as a list of words.
fn sentences(text: &str) -> Vec<Vec<&str>> {
    let mut sentences = vec![Vec::new()];
    for word in text.split_whitespace() {
        if word != "." {
            sentences.last_mut().expect("a sentence").push(word);
        }
        if word.trim_end_matches([')', '*', '`', '"']).ends_with(['.', '!', '?', ':', ';']) {
            sentences.push(Vec::new());
        }
    }
    sentences
}

#[test]
fn sentences_end_before_they_must_be_read_twice() {
    for document in &documents() {
        let text = paragraphs(&text(document));
        let long: Vec<String> =
            sentences(&text).iter().filter(|words| words.len() > MOST_WORDS).map(|words| words.join(" ")).collect();
        assert!(long.is_empty(), "{}: {long:#?}", document.display());
    }
}

/// Words that replace a noun, so that readers must read the sentence twice.
const STAND_INS: [&str; 2] = ["whoever", "so many"];

#[test]
fn nouns_stand_for_people_and_numbers() {
    let mut found = Vec::new();
    let mut look = |path: &Path, text: &str| {
        let text = text.to_lowercase();
        found.extend(
            STAND_INS.iter().filter(|word| text.contains(**word)).map(|word| format!("{}: {word}", path.display())),
        );
    };
    for document in documents().iter().filter(|path| !path.ends_with("CHANGELOG.md")) {
        look(document, &paragraphs(&text(document)));
    }
    let sources = ["src", "crates"].map(|folder| files(&root().join(folder), ".rs")).concat();
    for source in &sources {
        let text = text(source);
        let comments: Vec<&str> = text.lines().filter(|line| line.trim_start().starts_with("//")).collect();
        look(source, &comments.join("\n"));
    }
    assert!(found.is_empty(), "{found:#?}");
}

/// British spellings. The project uses American spelling. Names of published scenes keep theirs.
const BRITISH: [&str; 14] = [
    "artefact",
    "behaviour",
    "centre",
    "colour",
    "favour",
    "licence",
    "neighbour",
    "initialis",
    "normalis",
    "optimis",
    "organis",
    "recognis",
    "sanitis",
    "serialis",
];

#[test]
fn spelling_is_american() {
    let folders = ["src", "crates", "docs", "tests", "examples", "python", "scripts", "integrations", "benches"];
    let is_read = |path: &PathBuf| {
        let kinds = [".rs", ".md", ".js", ".html", ".css", ".toml", ".py", ".snap"];
        kinds.iter().any(|kind| name(path).ends_with(kind)) && !path.ends_with("prose.rs")
    };
    let sources = folders.map(|folder| files(&root().join(folder), "")).concat();
    let mut found = Vec::new();
    for path in sources.iter().filter(|path| is_read(path)).chain(&documents()) {
        let text = text(path).to_lowercase().replace("off-centre", "").replace("of-centre-on", "");
        let text = text.replace("many-neighbours", "");
        found.extend(BRITISH.iter().filter(|word| text.contains(**word)).map(|word| format!("{}: {word}", name(path))));
    }
    assert!(found.is_empty(), "{found:#?}");
}

/// Comments that begin with such a word have no subject: "What a worker does" does not say what the item is.
const QUESTIONS: [&str; 4] = ["What", "Who", "Whatever", "Whoever"];

#[test]
fn comments_begin_with_a_subject() {
    let sources = ["src", "crates", "tests", "benches", "fuzz", "python/src"];
    let sources = sources.map(|folder| files(&root().join(folder), ".rs")).concat();
    let begins_so = |line: &str| {
        let comment = line.trim_start().strip_prefix("//").unwrap_or_default();
        let words = comment.trim_start_matches(['/', '!']);
        QUESTIONS.contains(&words.split_whitespace().next().unwrap_or_default().trim_end_matches([':', ',']))
    };
    let count = |path: &PathBuf| text(path).lines().filter(|line| begins_so(line)).count();
    let found: Vec<(String, usize)> =
        sources.iter().map(|path| (path.display().to_string(), count(path))).filter(|(_, count)| *count > 0).collect();
    let all: usize = found.iter().map(|(_, count)| count).sum();
    assert_eq!(all, 0, "comments begin with a question: {found:#?}");
}

#[test]
fn readme_is_one_page() {
    let words = text(&root().join("README.md")).split_whitespace().count();
    assert!(words <= MOST_WORDS_OF_README, "README.md has {words} words");
}

/// Only the table of attacks, which a script generates, is longer. The pages in `docs/spec` are reference pages.
#[test]
fn pages_are_short() {
    for page in documents_in(&["docs", "docs/rules", "docs/sandbox", "docs/server"]) {
        let words = text(&page).split_whitespace().count();
        assert!(words <= MOST_WORDS_OF_PAGE || page.ends_with("attacks.md"), "{} has {words} words", page.display());
    }
}

/// Returns the anchors of a document's headings, as GitHub and mdBook create them.
fn anchors(text: &str) -> Vec<String> {
    let titles = text.lines().filter(|line| line.starts_with('#')).map(|line| line.trim_start_matches('#').trim());
    let kept = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    titles.map(|title| title.to_lowercase().replace(' ', "-").chars().filter(|c| kept(*c)).collect()).collect()
}

#[test]
fn links_of_documents_lead_to_files_and_headings() {
    let mut links = 0;
    let mut dead = Vec::new();
    for document in documents().into_iter().chain(documents_in(&["docs/spec"])) {
        let folder = document.parent().expect("a folder");
        let text_here = text(&document);
        let inline = text_here.split("](").skip(1).filter_map(|part| part.split(')').next());
        let defined = text_here.lines().filter(|line| line.starts_with('[')).filter_map(|line| line.split_once("]: "));
        for target in inline.chain(defined.map(|(_, target)| target)) {
            if target.starts_with("http") {
                continue;
            }
            links += 1;
            let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
            let path = if file.is_empty() { document.clone() } else { folder.join(file) };
            // The book contains only the pages of `docs`, and gives a folder's `README.md` another name.
            let is_in_book = document.starts_with(root().join("docs")) && !document.ends_with("SUMMARY.md");
            let is_outside = path.canonicalize().is_ok_and(|path| !path.starts_with(root().join("docs")));
            if !path.exists()
                || is_in_book && (is_outside || path.ends_with("README.md"))
                || !anchor.is_empty() && !anchors(&text(&path)).iter().any(|known| known == anchor)
            {
                dead.push(format!("{}: {target}", document.display()));
            }
        }
    }
    assert!(dead.is_empty(), "{dead:#?}");
    assert!(links > 90, "{links} links: are these the documents?");
}

/// Every setting of the server needs a row in its pages.
#[test]
fn settings_of_the_server_have_their_rows() {
    let arguments = text(&root().join("crates/server/src/cli/arguments.rs"));
    let pages: String = documents_in(&["docs/server"]).iter().map(|page| text(page)).collect();
    let names: Vec<&str> = arguments.split("env = \"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert!(names.len() > 10, "{names:?}: is this where they are declared?");
    let missing: Vec<_> = names.into_iter().filter(|name| !pages.contains(name)).collect();
    assert!(missing.is_empty(), "docs/server names no {missing:?}");
}

/// Every page of `docs` is in the table of contents.
#[test]
fn the_table_of_contents_has_every_page() {
    let contents = text(&root().join("docs/SUMMARY.md"));
    let pages = documents().into_iter().chain(documents_in(&["docs/spec"]));
    for name in pages.filter_map(|path| path.strip_prefix(root().join("docs")).map(Path::to_path_buf).ok()) {
        let name = name.to_string_lossy();
        assert!(name == "SUMMARY.md" || contents.contains(&format!("({name})")), "docs/SUMMARY.md has no {name}");
    }
}

/// Returns the words between backticks in a document.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// Each source that a document names exists. A document may omit the beginning of its path.
#[test]
fn named_sources_exist() {
    let sources: Vec<String> = sources().iter().map(|path| format!("/{}", name(path))).collect();
    for document in documents() {
        let is_missing = |word: &&str| {
            let is_source = word.ends_with(".rs") && !word.contains(['<', '{', '*', ' ']);
            is_source && !sources.iter().any(|source| source.ends_with(&format!("/{word}")))
        };
        let missing: Vec<String> = quoted(&text(&document)).filter(is_missing).map(str::to_owned).collect();
        assert!(missing.is_empty(), "{} names files that do not exist: {missing:#?}", document.display());
    }
}

/// Each invariant names a test or a command that checks it.
#[test]
fn invariants_name_what_holds_them() {
    let page = text(&root().join("ARCHITECTURE.md"));
    let section = page.split("\n## Invariants\n").nth(1).expect("a section").split("\n## ").next().expect("a section");
    let invariants: Vec<&str> = section.split("\n- **").skip(1).collect();
    assert!(invariants.len() > 20, "{} invariants", invariants.len());
    for invariant in invariants {
        let (_, held) = invariant.split_once("**").expect("an end of the bold text");
        assert!(quoted(held).next().is_some(), "nothing holds: {invariant}");
    }
}
