//! The example course, with which people try the service. A new server creates it on request.
use crate::domain::{
    App, NewSecret, Settings,
    accounts::identity::{self, SignInMethod},
    roles::admin,
    view,
};
use crate::{
    problem::{Problem, ensure},
    values,
};

/// The name and title of the course. An existing course with this name is taken for the example.
const COURSE: (&str, &str) = ("example", "Example course");
const ASSIGNMENT: (&str, &str) = ("m1", "Theme 2, Milestone 2: continuous-time collisions");
const STUDENT: (&str, &str) = ("student", "A student");

impl App {
    /// Creates the example course, with an assignment and a student, if there is no course yet. Returns a sign-in link
    /// for the student; `None` if the example was created before.
    ///
    /// # Errors
    ///
    /// Fails if there are other courses, or another account is called `student`, because the server is then in real
    /// use.
    pub async fn example(&self) -> Result<Option<NewSecret>, Problem> {
        let mut transaction = self.0.database.begin().await?;
        let statement = "SELECT count(*) AS courses, count(CASE WHEN slug = ? THEN 1 END) AS examples FROM course";
        let counts = transaction.one(statement, values![COURSE.0]).await?;
        if counts.int("examples")? == 0 {
            ensure(
                counts.int("courses")? <= 0,
                Problem::conflict("this server already has courses", "start the server without --example"),
            )?;
            let settings = Settings::default().validate(&self.suites)?;
            let course = admin::make_course(&mut transaction, COURSE).await?;
            let text = format!("{} ({}), as --example asks", COURSE.0, COURSE.1);
            view::log_event(&mut transaction, &view::LogEntry::new("course", None, &text)).await?;
            let statement = "INSERT INTO assignment (course, slug, title, visible, settings, created_at)
                VALUES (?, ?, ?, 1, ?, {now})";
            transaction.execute(statement, values![course, ASSIGNMENT.0, ASSIGNMENT.1, settings.to_json()]).await?;
            let statement = "INSERT INTO account (login, name, managed_by, created_at) VALUES (?, ?, ?, {now})
                ON CONFLICT (login) DO NOTHING RETURNING id";
            let created = transaction.row(statement, values![STUDENT.0, STUDENT.1, course]).await?;
            let Some(student) = created else {
                return Err(Problem::conflict("an account `student` exists", "start the server without --example"));
            };
            let statement = "INSERT INTO member (course, account, role, created_at) VALUES (?, ?, 'student', {now})";
            transaction.execute(statement, values![course, student.int("id")?]).await?;
        }
        let statement = "SELECT account.id FROM account
            JOIN member ON member.account = account.id AND member.role = 'student'
            JOIN course ON course.id = member.course AND course.slug = ?
            WHERE account.login = ? AND account.is_admin = 0
               AND (SELECT count(*) FROM member AS other WHERE other.account = account.id) = 1
               AND NOT EXISTS (SELECT 1 FROM sign_in_link
                   WHERE sign_in_link.account = account.id AND sign_in_link.used_at IS NOT NULL)";
        let student = transaction.row(statement, values![COURSE.0, STUDENT.0]).await?;
        let link = match student {
            Some(student) => {
                Some(identity::new_link(&mut transaction, student.int("id")?, None, SignInMethod::Own).await?)
            }
            None => None,
        };
        transaction.commit().await?;
        Ok(link)
    }
}
