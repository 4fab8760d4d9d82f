//! Past grades are made again, and compared.
use crate::support::{
    engines::{Fresh, on_both_engines},
    server::{Server, program},
};
use std::{fs, process::Command};

on_both_engines!(a_past_grade_is_made_again_byte_for_byte);

async fn a_past_grade_is_made_again_byte_for_byte(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let id = ada.submit("physics", &program("WA", 40));
    let graded = ada.wait_for_grade("physics", id);
    let history = ada.get(&format!("/api/v1/courses/physics/submissions/{id}/history")).expect(200).json();
    assert_eq!(history[0]["essence"], graded["grade"]["essence"]);
    assert_eq!(history[0]["grader"].as_str().expect("a digest").len(), 64);
    let upload = fosssim_server::store::Digest::of(&program("WA", 40));
    assert_eq!(history[0]["by_what"], format!("suite t2m2, rules of the suite, upload {}", upload.short()));
    let page = ada.get(&format!("/c/physics/s/{id}")).expect(200).text();
    assert!(page.contains(upload.short()) && page.contains("suite t2m2"), "{page}");
    let (folder, grader, database) = (server.folder.clone(), server.grader(), server.database());
    let replay = |grader: &std::path::Path, words: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_fosssim-server"))
            .arg("replay")
            .args(words)
            .arg("--grader")
            .arg(grader)
            .arg("--data")
            .arg(&folder)
            .env("FOSSSIM_DATABASE", &database)
            .output()
            .expect("an answer");
        let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        (output.status.code(), text)
    };
    // While the server runs, and although times differ.
    let number = id.to_string();
    let (code, said) = replay(&grader, &[&number]);
    assert!(code == Some(0) && said.contains("WA, 40 points, the same grader"), "{code:?} {said}");
    assert!(said.contains("the same, byte for byte"), "{said}");
    // A grader that comes to something else is told apart, with what differs.
    let other = grader.with_file_name("other-grader");
    let text = fs::read_to_string(&grader).expect("a script");
    fs::write(&other, text.replace("a step is wrong", "another step is wrong")).expect("written");
    fs::set_permissions(&other, fs::metadata(&grader).expect("a file").permissions()).expect("permissions");
    let (code, said) = replay(&other, &[&number]);
    assert!(code == Some(1) && said.contains("ANOTHER GRADE"), "{code:?} {said}");
    assert!(said.contains("/grades/0/groups/1/scenes/0/summary: \"a step is wrong\" then, \"another"), "{said}");
    let (code, said) = replay(&grader, &["999"]);
    assert!(code == Some(2) && said.contains("there is no submission 999"), "{code:?} {said}");
    // Nothing changes by it.
    assert_eq!(ada.get(&format!("/api/v1/courses/physics/submissions/{id}/history")).expect(200).json(), history);
}
