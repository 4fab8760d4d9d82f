//! What a suite hides from students, the service does not show them.
use crate::support::{
    engines::{Fresh, on_both_engines},
    server::Server,
};

on_both_engines!(reports_that_tell_of_hidden_groups_are_for_staff);

async fn reports_that_tell_of_hidden_groups_are_for_staff(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let teacher = server.member(&admin, "physics", "teacher", "staff");
    let ada = server.member(&admin, "physics", "ada", "student");
    let hidden = ada.submit("physics", b"#!grade WA 40 Secret/scene 3\n");
    let open = ada.submit("physics", b"#!grade WA 40 Group/scene 3\n");
    for id in [hidden, open] {
        ada.wait_for_grade("physics", id);
    }
    for name in ["grade.json", "report.txt"] {
        for place in ["api/v1/courses/physics/submissions", "c/physics/s"] {
            let path = |id: i64| match place {
                "c/physics/s" => format!("/{place}/{id}/report/{name}"),
                _ => format!("/{place}/{id}/files/{name}"),
            };
            ada.get(&path(hidden)).expect(404);
            teacher.get(&path(hidden)).expect(200);
            ada.get(&path(open)).expect(200);
        }
    }
    // The page for students is made without them.
    ada.get(&format!("/api/v1/courses/physics/submissions/{hidden}/files/report.html")).expect(200);
    let page = ada.get(&format!("/c/physics/s/{hidden}")).expect(200).text();
    assert!(page.contains("report.html") && !page.contains("grade.json") && !page.contains("Report as text"), "{page}");
    let page = teacher.get(&format!("/c/physics/s/{hidden}")).expect(200).text();
    assert!(page.contains("grade.json") && page.contains("Report as text"), "{page}");
}
