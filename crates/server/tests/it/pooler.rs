//! Tests the service behind PgBouncer, with many clients and few connections.
use crate::support::{
    engines::{Fresh, run},
    server::{Server, program},
};

/// If a session listened for notifications, they would arrive in other clients' transactions and end them.
#[test]
fn nobody_is_refused_behind_a_pooler() {
    run(async {
        let Some(fresh) = Fresh::pooled().await else { return };
        let mut server = Server::start(&fresh, &["--workers", "2", "--requests-per-minute", "100000"]);
        let admin = server.admin();
        server.course(&admin, "physics");
        let students: Vec<_> =
            (0..6).map(|number| server.member(&admin, "physics", &format!("s{number}"), "student")).collect();
        let clients: Vec<_> = (0..30_usize)
            .map(|number| {
                let student = students[number % students.len()].clone();
                std::thread::spawn(move || {
                    let path = "/api/v1/courses/physics/assignments/m1/submissions?name=FOSSSim";
                    (0..3).map(|_| student.send("POST", path, &[], &program("WA", 1)).status).collect::<Vec<_>>()
                })
            })
            .collect();
        let mut answers: Vec<u16> = Vec::new();
        for client in clients {
            answers.extend(client.join().expect("a client"));
        }
        assert_eq!(answers, [201; 90]);
        let handed_in: usize = students
            .iter()
            .map(|student| {
                let all = student.get("/api/v1/courses/physics/assignments/m1/submissions").expect(200).json();
                all.as_array().expect("a list").len()
            })
            .sum();
        assert_eq!(handed_in, 90);
        let log = server.log();
        assert!(!log.contains("NotificationResponse"), "{log}");
    });
}
