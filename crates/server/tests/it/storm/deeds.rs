//! Actions of staff and bad uploads during a storm, in a separate course: regrades, publishing, settings, removals and
//! archive bombs. Requests that reach no server are not repeated.
use crate::support::server::{Client, JSON, Server, bomb, program};

const COURSE: &str = "/api/v1/courses/noise";

/// The people who perform these actions.
pub(super) struct Noise {
    admin: Client,
    student: Client,
    bomb: Vec<u8>,
    deeds: usize,
}

impl Noise {
    /// Creates the course, its student, and an assignment with a few submissions.
    pub(super) fn begin(server: &Server, admin: &Client) -> Self {
        server.course(admin, "noise");
        let student = server.member(admin, "noise", "noisy", "student");
        for points in 0..3 {
            student.submit("noise", &program("WA", points));
        }
        Self { admin: admin.clone(), student, bomb: bomb(80), deeds: 0 }
    }

    /// Performs the next action on this server.
    pub(super) fn act(&mut self, server: &Server) {
        self.deeds += 1;
        let number = self.deeds;
        let at = |client: &Client| Client { url: server.url.clone(), headers: client.headers.clone() };
        let (admin, student) = (at(&self.admin), at(&self.student));
        let send = |client: &Client, method: &str, path: &str, kind, body: &[u8]| {
            let answer = client.try_send(method, &format!("{COURSE}{path}"), kind, body).ok();
            assert!(answer.as_ref().is_none_or(|answer| answer.status != 500), "{method} {path}: {answer:?}");
            answer
        };
        let m1 = "/assignments/m1";
        match number % 5 {
            0 => {
                let base = format!("{m1}/regrades");
                let Some(regrades) = send(&admin, "GET", &base, &[], b"").filter(|answer| answer.status == 200) else {
                    return;
                };
                let regrades = regrades.json();
                match regrades.as_array().expect("a list").iter().find(|regrade| regrade["state"] == "open") {
                    None => send(&admin, "POST", &base, JSON, br#"{"reason": "another look", "settings": {}}"#),
                    Some(open) => {
                        let end = if number.is_multiple_of(2) { "apply" } else { "discard" };
                        send(&admin, "POST", &format!("{base}/{}/{end}", open["id"]), &[], b"")
                    }
                };
            }
            1 => {
                let method = if number.is_multiple_of(2) { "PUT" } else { "DELETE" };
                send(&admin, method, &format!("{m1}/published"), &[], b"");
            }
            2 => {
                let wish = format!(r#"{{"title": "M", "visible": true, "settings": {{"late_days": {}}}}}"#, number % 7);
                send(&admin, "PUT", m1, JSON, wish.as_bytes());
            }
            3 => {
                let short = format!("/assignments/short{number}");
                send(&admin, "PUT", &short, JSON, br#"{"title": "Short", "visible": true, "settings": {}}"#);
                send(&student, "POST", &format!("{short}/submissions"), &[], &program("WA", 3));
                send(&admin, "DELETE", &short, &[], b"");
            }
            _ => {
                let answer = send(&student, "POST", &format!("{m1}/submissions"), &[], &self.bomb);
                let status = answer.map(|answer| answer.status);
                assert!(status.is_none_or(|status| matches!(status, 422 | 429 | 503)), "a bomb is taken: {status:?}");
            }
        }
    }

    /// Returns the number of attempted actions.
    pub(super) fn deeds(&self) -> usize {
        self.deeds
    }
}
