//! Imports a class from a table (CSV) in the form that spreadsheets write. The columns are name, login, e-mail address
//! and role.
use crate::domain::{Staff, courses::members::check_member};
use crate::problem::{Problem, ensure};
use serde::Serialize;
use std::collections::BTreeSet;
use utoipa::ToSchema;

/// The maximum number of lines in a table.
const MAX_LINES: usize = 5000;

/// The names of each column, in the default order of columns. The first name of each is the usual one.
const COLUMNS: [&[&str]; 4] = [
    &["name", "fullname"],
    &["login", "username", "loginname", "userid"],
    &["email", "emailaddress", "mail"],
    &["role"],
];

/// A line of a table of members, and the result of its import.
#[derive(Serialize, ToSchema)]
pub struct MemberLine {
    pub(crate) line: u64,
    pub(crate) name: String,
    pub(crate) login: String,
    // The mail address to which the link can be sent. The database does not store it.
    pub(crate) email: String,
    pub(crate) role: String,
    /// The headings of columns that are not stored, but have a value in this line.
    pub(crate) unused: Vec<String>,
    // Whether the line may contain unknown headings: it is the first one, and has no e-mail address.
    #[serde(skip)]
    pub(crate) may_be_heading: bool,
    /// The error in the line; any error stops the whole import.
    pub(crate) error: Option<String>,
    /// The member's sign-in link; `None` if the account existed already.
    pub(crate) link: Option<String>,
}

/// Returns the column that a heading names. For example, "E-mail address" names the column "email".
fn find_column(heading: &str) -> Option<usize> {
    let plain: String = heading.to_lowercase().chars().filter(|c| c.is_alphanumeric()).collect();
    COLUMNS.iter().position(|names| names.contains(&plain.as_str()))
}

/// Returns the positions of the four columns according to the headings in the first line; `None` if the line has no
/// headings.
fn read_headings(cells: &[String]) -> Result<Option<[Option<usize>; 4]>, Problem> {
    if cells.iter().all(|heading| find_column(heading).is_none()) {
        return Ok(None);
    }
    let mut columns = [None; COLUMNS.len()];
    for (index, heading) in cells.iter().enumerate().filter(|(_, heading)| !heading.is_empty()) {
        if find_column(heading).is_some_and(|column| columns[column].replace(index).is_some()) {
            return Err(Problem::invalid(format!("the column {heading} occurs twice")));
        }
    }
    match columns {
        [Some(_), Some(_), ..] => Ok(Some(columns)),
        [name, _, ..] => {
            let (missing, found) = (COLUMNS[usize::from(name.is_some())][0], cells.join(", "));
            Err(Problem::invalid(format!("no column is called {missing}, only {found}")))
        }
    }
}

/// Reads a table. Errors are reported in the lines that contain them.
fn read(text: &str) -> Result<Vec<MemberLine>, Problem> {
    let first = text.lines().next().unwrap_or_default();
    // Spreadsheets of other countries use other separators.
    let delimiter = *b";\t,".iter().max_by_key(|c| first.bytes().filter(|byte| byte == *c).count()).unwrap_or(&b',');
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let mut columns: [Option<usize>; COLUMNS.len()] = std::array::from_fn(Some);
    let mut headings = Vec::new();
    let mut logins = BTreeSet::new();
    let mut lines = Vec::new();
    let mut counted = (0, 1);
    for (index, record) in reader.records().enumerate() {
        let record = record.map_err(|error| Problem::invalid(format!("the table can't be read: {error}")))?;
        let cell = |text: &str| text.trim_start_matches('\u{feff}').to_owned();
        let cells: Vec<String> = record.iter().map(cell).collect();
        if index == 0
            && let Some(found) = read_headings(&cells)?
        {
            (columns, headings) = (found, cells);
            continue;
        }
        let is_extra = |(index, value): &(usize, &String)| !value.is_empty() && !columns.contains(&Some(*index));
        let extra = cells.iter().enumerate().filter(is_extra);
        // An unknown heading is an error, so that no column is ignored silently.
        let unused: Option<Vec<String>> =
            extra.map(|(index, _)| headings.get(index).filter(|name| !name.is_empty()).cloned()).collect();
        let field = |column: usize| columns[column].and_then(|index| record.get(index)).map(cell).unwrap_or_default();
        // The CSV reader counts the second byte of a line end as part of the next line.
        let offset = record.position().map_or(0, |position| usize::try_from(position.byte()).unwrap_or(0));
        let line_ends = |bytes: &[u8]| bytes.iter().filter(|byte| **byte == b'\n').count() as u64;
        counted = (offset, counted.1 + line_ends(text.as_bytes().get(counted.0..offset).unwrap_or_default()));
        let line = counted.1 + u64::from(text.as_bytes().get(offset) == Some(&b'\n'));
        let (name, login, email) = (field(0), field(1).to_lowercase(), field(2));
        let role =
            Some(field(3).to_lowercase()).filter(|role| !role.is_empty()).unwrap_or_else(|| "student".to_owned());
        let error = match check_member(&login, &name, &role) {
            Err(problem) => Some(problem.detail),
            Ok(()) if !logins.insert(login.clone()) => Some("the login appears twice in the table".to_owned()),
            Ok(()) if !email.is_empty() && !email.contains('@') => Some("the e-mail address has no @".to_owned()),
            Ok(()) if unused.is_none() => Some("this line has more fields than name, login, email and role".to_owned()),
            Ok(()) => None,
        };
        let (unused, may_be_heading) = (unused.unwrap_or_default(), index == 0 && !email.contains('@'));
        lines.push(MemberLine { line, name, login, email, role, unused, may_be_heading, error, link: None });
        ensure(lines.len() <= MAX_LINES, Problem::invalid(format!("a table has at most {MAX_LINES} lines")))?;
    }
    if lines.is_empty() { Err(Problem::invalid("the table has no lines: name, login, email, role")) } else { Ok(lines) }
}

impl Staff {
    /// Adds all members in a table if no line has an error. With `preview`, nobody is added.
    ///
    /// # Errors
    ///
    /// Fails if the text is not a table, or if a member in it was changed after the event `seen_event`.
    pub async fn import(&self, text: &str, preview: bool, seen_event: Option<i64>) -> Result<Vec<MemberLine>, Problem> {
        let mut lines = read(text)?;
        if lines.iter().any(|line| line.error.is_some()) {
            return Ok(lines);
        }
        let mut transaction = self.begin().await?;
        // Members are added in the order of their logins, so that two simultaneous imports cannot deadlock.
        let mut sorted_lines: Vec<&mut MemberLine> = lines.iter_mut().collect();
        sorted_lines.sort_by(|one, other| one.login.cmp(&other.login));
        for line in sorted_lines {
            self.check_last_event(&mut transaction, ("member", None), &format!("{} ", line.login), seen_event).await?;
            match self.add_member(&mut transaction, &line.login, &line.name, &line.role).await {
                Ok(link) => line.link = link,
                Err(problem) if problem.status < 500 => line.error = Some(problem.detail),
                Err(problem) => return Err(problem),
            }
        }
        if preview || lines.iter().any(|line| line.error.is_some()) {
            lines.iter_mut().for_each(|line| line.link = None);
            return Ok(lines);
        }
        transaction.commit().await?;
        Ok(lines)
    }
}

#[cfg(test)]
mod tests {
    use super::read;

    #[test]
    fn tables_are_read_as_spreadsheets_write_them() {
        let lines = |text: &str| read(text).expect("a table");
        let plain = lines("Ada Lovelace,ada,ada@example.org,staff\n\"Babbage, C.\",Charles\n");
        assert_eq!((plain[0].role.as_str(), plain[1].role.as_str()), ("staff", "student"));
        assert_eq!((plain[1].name.as_str(), plain[1].login.as_str(), plain[1].line), ("Babbage, C.", "charles", 2));
        let named = lines("\u{feff}Login;Role;Name\r\nada;student;Ada\r\n");
        assert_eq!((named[0].login.as_str(), named[0].name.as_str(), named[0].line), ("ada", "Ada", 2));
        let others = lines("User name;E-Mail;NAME;\nada;ada@example.org;Ada\n");
        assert_eq!((others[0].login.as_str(), others[0].email.as_str()), ("ada", "ada@example.org"));
        for bad in ["Name,Email\nAda,a@b\n", "Vorname,Login\nAda,ada\n", "Login,Name,Login\nada,Ada,eve\n"] {
            assert!(read(bad).is_err(), "{bad}");
        }
        let more = lines("Login,Name,Number,Group\nada,Ada,7,\n");
        assert_eq!((more[0].unused.join(", "), &more[0].error), ("Number".to_owned(), &None));
        assert!(lines("Ada,ada,,student,7\n")[0].error.is_some(), "nothing is dropped in silence");
        assert!(lines("Login,Name\nada,Ada,7\n")[0].error.is_some());
        let wrong = lines("Ada,ada\nAda,ada\n,eve\nEve,e v e\nEve,eve,,boss\n");
        let errors: Vec<bool> = wrong.iter().map(|line| line.error.is_some()).collect();
        assert_eq!(errors, [false, true, true, true, true]);
        let both = lines("Eve,e v e,,boss\n")[0].error.clone().expect("errors");
        assert!(both.contains("a login") && both.contains("a role"), "{both}");
        assert!(lines("who,what,post\nAda,ada,ada@example.org\n")[0].error.is_some(), "an unknown heading");
        assert!(read("").is_err());
        assert!(lines(r#"[{"name": "Ada", "login": "ada"}]"#)[0].error.is_some(), "JSON");
    }
}
