//! The page of a class: who got what, which scenes few have right, and who makes the same mistake.
use super::{
    document,
    graded::key,
    markup::{data, note, table, text},
    smallest::pre,
};
use crate::foreign::one_line;
use crate::{
    grade::{
        ClassFigures, SharedMistake, frequent, hardest, likely_mistakes, never_ran, points, reached, same_programs,
    },
    number::counted,
    smallest::title,
    words,
};
use fosssim_findings::{Grade, PassedOver, SceneGrade, Verdict};
use fosssim_mistakes::diagnose::{Explanation, is_named_in};
use std::{collections::BTreeMap, fmt::Write};

const SCRIPT: &str = include_str!("class.js");

/// Bars of the histogram.
const BARS: usize = 10;

/// The greatest number of characters of a likely mistake or a summary in a table.
const SHORT: usize = 120;

/// The greatest number of shared mistakes that are not folded: the table begins on the first screen.
const FEW: usize = 5;

/// The greatest number of names listed of a cluster.
const NAMES: usize = 400;

/// The grades of a class.
#[derive(Clone, Copy)]
pub struct ClassPage<'a> {
    /// The grades.
    pub grades: &'a [Grade],
    /// The entries that are no submissions.
    pub passed_over: &'a [PassedOver],
    /// The address of a submission's page, relative to this one.
    pub page: &'a dyn Fn(&Grade) -> String,
}

impl ClassPage<'_> {
    /// Renders the file.
    #[must_use]
    pub fn html(&self) -> String {
        let suite = self.grades.first().map_or("", |grade| grade.suite.as_str());
        let mut body = format!("<h1>Class: {}</h1>\n", text(&one_line(suite)));
        body += &figures(self.grades);
        let mistakes = frequent(self.grades);
        body += "<div class=\"split halves\">\n";
        body += &histogram(self.grades);
        body += &self.clusters(&mistakes);
        body += "</div>\n";
        body += &self.table(&mistakes);
        body += &self.same_programs();
        body += &self.scenes();
        body += &self.differing();
        document(&format!("Class: {suite}"), &body, SCRIPT)
    }

    fn link(&self, grade: &Grade) -> String {
        // A name that is written from right to left must not turn the text around it.
        format!("<a href=\"{}\"><bdi>{}</bdi></a>", text(&(self.page)(grade)), text(&one_line(&grade.submission)))
    }

    fn links(&self, members: &[usize]) -> String {
        let shown: Vec<String> = members.iter().take(NAMES).map(|&number| self.link(&self.grades[number])).collect();
        let more = members.len().saturating_sub(NAMES);
        shown.join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() }
    }

    /// Returns the search, and the filters by verdict and by mistake.
    fn filters(&self, mistakes: &[SharedMistake]) -> String {
        let count = |wanted: &str| self.grades.iter().filter(|grade| state(grade) == wanted).count();
        let states = [
            ("good", "accepted", count("good")),
            ("bad", "not accepted", count("bad")),
            ("none", "never ran", count("none")),
            ("left", "not graded", self.passed_over.len()),
        ];
        let option =
            |value: &str, words: &str, count: usize| format!("<option value=\"{value}\">{words} ({count})</option>");
        let states = states.iter().filter(|(.., count)| *count > 0);
        let states: String = states.map(|(value, words, count)| option(value, words, *count)).collect();
        let named = mistakes.iter().enumerate().map(|(number, one)| {
            let words = short(&one_line(&words::explanation::what_or(&one.mistake)));
            option(&format!("m{number}"), &text(&words), one.members.len())
        });
        let named: String = named.collect();
        format!(
            "<p class=\"filter rows\" hidden><label>Filter <input type=\"search\"></label> \
             <label>Verdict <select data-by=\"state\"><option value=\"\">any</option>{states}</select></label> \
             <label>Mistake <select data-by=\"mistakes\"><option value=\"\">any</option>{named}</select></label> \
             <output></output></p>\n"
        )
    }

    fn table(&self, mistakes: &[SharedMistake]) -> String {
        let names: Vec<&str> =
            self.grades.first().iter().flat_map(|grade| grade.scenes()).map(|one| one.scene.as_str()).collect();
        let mut out = format!(
            "<h2>Submissions</h2>\n{}<p class=\"hint keys\">Scenes in the order of the suite: \
             <span><span class=\"h h-r\"></span> accepted</span> <span><span class=\"h h-w\"></span> wrong</span> \
             <span><span class=\"h h-e\"></span> crashed, too slow or unreadable</span> \
             <span><span class=\"h h-n\"></span> not run</span> <output class=\"pointed\"></output></p>\n\
             <script type=\"application/json\" id=\"scenes\">{}</script>\n",
            self.filters(mistakes),
            data(&serde_json::json!(names))
        );
        let (is_compared, differ) = (
            self.grades.iter().any(|grade| grade.before.is_some()),
            self.grades.iter().any(|grade| grade.differing() > 0),
        );
        let mut headings = vec!["submission", "verdict", "#points", "#before"];
        headings.truncate(if is_compared { 4 } else { 3 });
        headings.extend(["#accepted", "scenes", "likely mistakes, or the reason", "#rule books differ"]);
        headings.truncate(headings.len() - usize::from(!differ));
        out += &table("card scroll", "Submissions", "sortable stack class", &headings);
        for (number, grade) in self.grades.iter().enumerate() {
            out += &self.row(number, grade, mistakes, (is_compared, differ));
        }
        for entry in self.passed_over {
            let (name, why) = (text(&one_line(&entry.name)), text(&one_line(&entry.why)));
            let blank = |is_there: bool| if is_there { "<td data-sort=\"\"></td>" } else { "" };
            let _ = writeln!(
                out,
                "<tr data-state=\"left\"><th scope=\"row\"><bdi>{name}</bdi></th>\
                 <td><span class=\"chip none\">not graded</span></td>{0}{1}{0}{0}\
                 <td class=\"words\">{why}</td>{2}</tr>",
                blank(true),
                blank(is_compared),
                blank(differ)
            );
        }
        out + "</tbody></table></div>\n"
    }

    fn row(&self, number: usize, grade: &Grade, mistakes: &[SharedMistake], shown: (bool, bool)) -> String {
        let sort = |points: Option<f64>| points.map_or_else(String::new, |points| points.to_string());
        let (accepted, all) = (grade.count(Verdict::Accepted), grade.scenes().count());
        let made = mistakes.iter().enumerate().filter(|(_, one)| one.members.contains(&number));
        let made: Vec<String> = made.map(|(place, _)| format!("m{place}")).collect();
        let likely = likely_mistakes(grade).into_iter().map(|(mistake, _)| words::explanation::what_or(&mistake));
        let likely: Vec<String> = grade.located.iter().map(words::located).chain(likely).collect();
        let words = if likely.is_empty() { words::reason(grade).unwrap_or_default() } else { likely.join(" ") };
        let before = grade.changes().and_then(|changes| changes.points);
        let before =
            format!("<td class=\"num\" data-label=\"before\" data-sort=\"{}\">{}</td>", sort(before), reached(before));
        let differing =
            format!("<td class=\"num\" data-label=\"rule books differ\" data-sort=\"{0}\">{0}</td>", grade.differing());
        format!(
            "<tr data-state=\"{0}\" data-mistakes=\"{1}\"><th scope=\"row\">{2}</th>\
             <td><span class=\"chip {0}\">{3}</span></td>\
             <td class=\"num\" data-label=\"points\" data-sort=\"{4}\">{5} of {6}</td>{7}\
             <td class=\"num\" data-label=\"accepted\" data-sort=\"{accepted}\">{accepted} of {all}</td>\
             <td class=\"heat\" data-sort=\"{accepted}\">{8}</td><td class=\"words\">{9}</td>{10}</tr>\n",
            state(grade),
            made.join(" "),
            self.link(grade),
            grade.verdict.name(),
            sort(grade.points),
            reached(grade.points),
            points(grade.max_points),
            if shown.0 { &*before } else { "" },
            heat(grade),
            text(&short(&words)),
            if shown.1 { &*differing } else { "" },
        )
    }

    /// Returns the mistakes that several submissions make, the most frequent first.
    fn clusters(&self, mistakes: &[SharedMistake]) -> String {
        let named = mistakes.iter().enumerate().filter(|(_, one)| one.members.len() > 1);
        let mut found: Vec<String> = named
            .map(|(number, SharedMistake { mistake, members })| {
                let first = &self.grades[members[0]];
                let scene = first.scenes().find(|scene| is_named_in(mistake, &scene.explanations));
                let look = scene.map_or_else(String::new, |scene| {
                    let (page, key, name) = ((self.page)(first), key(&scene.scene), one_line(&scene.scene));
                    format!("To show it: <a href=\"{}#scene-{key}\">{}</a>. ", text(&page), text(&name))
                });
                let look = look + &note(first.note(mistake)) + &self.show_in_class(mistake, members);
                let heading = text(&one_line(&words::explanation::what_or(mistake)));
                self.cluster(&heading, members, &look, Some(number))
            })
            .collect();
        found.extend(by_signature(self.grades).iter().map(|members| {
            let wrong: Vec<&SceneGrade> = self.grades[members[0]].scenes().filter(|scene| is_failed(scene)).collect();
            let first =
                wrong.first().map_or(String::new(), |scene| format!("{}: {}", scene.scene, words::summary(scene)));
            let heading = match wrong.len() {
                1 => "No mistake is named, but the same scene fails in the same words".to_owned(),
                count => format!("No mistake is named, but the same {count} scenes fail in the same words"),
            };
            self.cluster(&heading, members, &format!("The first: {}. ", text(&short(&one_line(&first)))), None)
        }));
        let rest = found.split_off(found.len().min(FEW)).concat();
        let mut out = String::from("<section class=\"card\"><h2>The same mistake</h2>\n");
        if found.is_empty() {
            out += "<p>No two submissions make the same mistake.</p>";
        }
        out += &found.concat();
        if !rest.is_empty() {
            let _ = write!(out, "<details class=\"table\"><summary>More of them</summary>\n{rest}</details>");
        }
        out + "</section>\n"
    }

    /// Returns the smallest scene on which one of these submissions shows the mistake, for the blackboard.
    fn show_in_class(&self, mistake: &Explanation, members: &[usize]) -> String {
        let all = members.iter().flat_map(|&number| &self.grades[number].smallest);
        let named = all.filter(|small| is_named_in(mistake, &small.explanations));
        let Some(small) = named.min_by_key(|small| small.size()) else { return String::new() };
        let by_hand = small.by_hand.as_ref().map(|by_hand| &by_hand.text);
        let words: String = [Some(&small.xml), small.differs.as_ref(), by_hand]
            .into_iter()
            .zip(["The scene", "The values that differ", "By hand"])
            .filter_map(|(words, label)| Some(pre(label, words?)))
            .collect();
        format!("<details><summary>To show in class: {}</summary>{words}</details>", text(&title(small)))
    }

    /// Returns the submissions with the same program, group by group.
    fn same_programs(&self) -> String {
        let groups = same_programs(self.grades);
        if groups.is_empty() {
            return String::new();
        }
        let name = |&number: &usize| one_line(&self.grades[number].submission);
        let heading = |members: &Vec<usize>| text(&short(&members.iter().map(name).collect::<Vec<_>>().join(", ")));
        let groups: String = groups.iter().map(|members| self.cluster(&heading(members), members, "", None)).collect();
        format!("<section class=\"card\"><h2>The same program, byte for byte</h2>\n{groups}</section>\n")
    }

    /// Returns submissions with something in common: folded, with a link to each, to be copied into a letter and, by
    /// the number of their mistake, to be shown alone.
    fn cluster(&self, heading: &str, members: &[usize], look: &str, mistake: Option<usize>) -> String {
        let names: Vec<String> = members.iter().map(|&number| one_line(&self.grades[number].submission)).collect();
        let only = mistake.map_or_else(String::new, |number| {
            format!(" <button type=\"button\" data-only=\"m{number}\">Show only these</button>")
        });
        format!(
            "<details class=\"cluster\"><summary><b>{}</b> {heading}</summary>\n<div>{look}{}</div>\
             <p class=\"filter\" hidden><button type=\"button\" data-copy=\"{}\">Copy the names</button>{only}</p>\
             </details>\n",
            members.len(),
            self.links(members),
            text(&names.join(", "))
        )
    }

    /// Scenes that some have wrong.
    fn scenes(&self) -> String {
        let (scenes, whole) = hardest(self.grades);
        let mut out = String::from("<h2>Scenes by failure rate</h2>\n");
        if !scenes.is_empty() {
            let wrong = counted(scenes.len() as u64, "scene");
            let _ = write!(out, "<details class=\"table\"><summary>{wrong} that some have wrong</summary>");
            let headings = ["scene", "failed", "of", "rate"];
            out += &table("card scroll", "Scenes by failure rate", "sortable", &headings);
            for (scene, share) in scenes {
                let failed = share.run - share.accepted;
                let percent = 100 * failed / share.run.max(1);
                let _ = writeln!(
                    out,
                    "<tr><th scope=\"row\">{}</th><td class=\"num\" data-sort=\"{failed}\">{failed}</td>\
                     <td class=\"num\" data-sort=\"{1}\">{1}</td><td data-sort=\"{percent}\"><meter min=\"0\" max=\"100\" \
                     value=\"{percent}\" aria-label=\"failed\">{percent} %</meter> {percent} %</td></tr>",
                    self.shown(scene),
                    share.run
                );
            }
            out += "</tbody></table></div></details>\n";
        }
        match whole {
            0 => out,
            whole => out + &format!("<p>{} accepted for all.</p>\n", counted(whole as u64, "scene")),
        }
    }

    /// Returns a scene, as a link to the first submission that shows its fault.
    fn shown(&self, name: &str) -> String {
        let fails = |grade: &&Grade| grade.scenes().any(|scene| scene.scene == name && is_failed(scene));
        let words = text(&one_line(name));
        self.grades.iter().find(fails).map_or_else(
            || words.to_string(),
            |grade| format!("<a href=\"{}#scene-{}\">{words}</a>", text(&(self.page)(grade)), key(name)),
        )
    }

    fn differing(&self) -> String {
        let mut out = String::from("<h2>Where the rule books differ</h2>\n");
        let differing: Vec<&Grade> = self.grades.iter().filter(|grade| grade.differing() > 0).collect();
        if differing.is_empty() {
            return out + "<p>The rule books agree wherever both were applied.</p>\n";
        }
        let headings = ["submission", "scenes", "why, with the number of scenes"];
        out += &table("card scroll", "Where the rule books differ", "sortable", &headings);
        for grade in differing {
            let mut causes: BTreeMap<String, (usize, bool)> = BTreeMap::new();
            for cause in grade.scenes().filter_map(|scene| scene.differs) {
                causes.entry(cause.to_string()).or_insert((0, cause.original_fails())).0 += 1;
            }
            let words: Vec<String> = causes
                .into_iter()
                .map(|(cause, (count, fails))| {
                    let verdict = if fails { "the original fails them" } else { "the original passes them" };
                    format!("{count}: {cause} ({verdict})")
                })
                .collect();
            let _ = writeln!(
                out,
                "<tr><th scope=\"row\">{}</th><td class=\"num\" data-sort=\"{1}\">{1}</td><td>{2}</td></tr>",
                self.link(grade),
                grade.differing(),
                text(&words.join("; "))
            );
        }
        out + "</tbody></table></div>\n"
    }
}

/// Returns the beginning of a long text.
fn short(words: &str) -> String {
    let cut: String = words.chars().take(SHORT).collect();
    if cut.len() < words.len() { cut + "..." } else { cut }
}

/// Returns whether a scene counts as failed: scenes that were not run, or on which the grader failed, do not.
fn is_failed(scene: &SceneGrade) -> bool {
    !matches!(scene.verdict, Verdict::Accepted | Verdict::NotRun | Verdict::JudgeError)
}

/// Returns the state of a submission by which rows are filtered and colored.
fn state(grade: &Grade) -> &'static str {
    match grade {
        _ if grade.verdict.is_accepted() => "good",
        _ if never_ran(grade) => "none",
        _ => "bad",
    }
}

/// Returns the scenes of a submission in a row: those that are not accepted are drawn, each kind in a color of its
/// own.
fn heat(grade: &Grade) -> String {
    let (all, accepted) = (grade.scenes().count(), grade.count(Verdict::Accepted));
    let mut out = format!(
        "<svg viewBox=\"0 0 {} 1\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"{accepted} of {all} scenes \
        accepted\">",
        all.max(1)
    );
    for kind in ["w", "e", "n"] {
        let mut path = String::new();
        let mut place = 0;
        let is_this: Vec<bool> = grade.scenes().map(|scene| kind_of(scene) == Some(kind)).collect();
        for row in is_this.chunk_by(|one, other| one == other) {
            if row[0] {
                let _ = write!(path, "M{place} .5h{}", row.len());
            }
            place += row.len();
        }
        if !path.is_empty() {
            let _ = write!(out, "<path class=\"h-{kind}\" d=\"{path}\"/>");
        }
    }
    let mut borders = String::new();
    let mut place = 0;
    for group in grade.groups.iter().take(grade.groups.len().saturating_sub(1)) {
        place += group.scenes.len();
        let _ = write!(borders, "M{place} 0v1");
    }
    if !borders.is_empty() {
        let _ = write!(out, "<path class=\"h-g\" d=\"{borders}\"/>");
    }
    out + "</svg>"
}

/// Returns the style of a scene that is not accepted: wrong, without a trace that can be judged, or not run.
fn kind_of(scene: &SceneGrade) -> Option<&'static str> {
    match scene.verdict {
        Verdict::Accepted => None,
        Verdict::NotRun | Verdict::Unusable | Verdict::CompileError => Some("n"),
        verdict if verdict.is_wrong_trace() => Some("w"),
        _ => Some("e"),
    }
}

/// Returns the class in a few numbers.
fn figures(grades: &[Grade]) -> String {
    let figures = ClassFigures::from_grades(grades);
    let [mean, median, ..] = figures.points.map_or([None; 4], |all| all.map(Some)).map(reached);
    let unsolved = hardest(grades).0.iter().filter(|(_, share)| share.accepted == 0).count();
    let rows = [
        (format!("{} of {}", figures.ran, figures.submissions), "ran".to_owned()),
        (figures.accepted.to_string(), "accepted".to_owned()),
        (mean, format!("mean of {} points", points(figures.max_points))),
        (median, "median, both of those that ran".to_owned()),
        (unsolved.to_string(), "scenes without a right answer".to_owned()),
    ];
    let since =
        figures.since.map(|(more, fewer)| (format!("{more} / {fewer}"), "more / fewer points than before".to_owned()));
    let rows: String = rows
        .iter()
        .chain(&since)
        .map(|(number, words)| format!("<li class=\"card\"><b>{number}</b>{words}</li>"))
        .collect();
    format!("<ul class=\"kpi\">{rows}</ul>\n")
}

/// Returns submissions without a likely mistake that fail the same scenes in the same words, the largest cluster first.
fn by_signature(grades: &[Grade]) -> Vec<Vec<usize>> {
    let mut found: BTreeMap<Vec<(&str, Verdict, String)>, Vec<usize>> = BTreeMap::new();
    for (number, grade) in grades.iter().enumerate().filter(|(_, grade)| likely_mistakes(grade).is_empty()) {
        let failed = grade.scenes().filter(|scene| is_failed(scene));
        let signature: Vec<_> =
            failed.map(|scene| (scene.scene.as_str(), scene.verdict, words::summary(scene))).collect();
        if !signature.is_empty() {
            found.entry(signature).or_default().push(number);
        }
    }
    let mut several: Vec<_> = found.into_values().filter(|members| members.len() > 1).collect();
    several.sort_by_key(|members| std::cmp::Reverse(members.len()));
    several
}

/// Returns the number of submissions for each share of the points.
fn histogram(grades: &[Grade]) -> String {
    let shares: Vec<f64> = grades
        .iter()
        .filter_map(|grade| Some(grade.points? / grade.max_points))
        .filter(|share| share.is_finite())
        .collect();
    if shares.is_empty() {
        return String::new();
    }
    let mut counts = [0_usize; BARS];
    for share in shares {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "a bar"
        )]
        let bar = (share.clamp(0.0, 1.0) * BARS as f64) as usize;
        counts[bar.min(BARS - 1)] += 1;
    }
    let most = counts.iter().copied().max().unwrap_or(1).max(1);
    let names: Vec<String> = (0..BARS).map(|bar| format!("{} to {} %", 10 * bar, 10 * bar + 10)).collect();
    let words: Vec<String> = counts.iter().zip(&names).map(|(count, name)| format!("{name}: {count}")).collect();
    let title = "Points of the class";
    let mut out = format!(
        "<figure class=\"card\"><svg class=\"fp\" viewBox=\"0 0 340 190\" width=\"340\" height=\"190\" role=\"img\" \
         aria-label=\"{title}: {}\"><title>{title}</title>\n<text x=\"10\" y=\"16\">{title}, in percent of \
             all</text>\n",
        words.join(", ")
    );
    for (bar, count) in counts.into_iter().enumerate() {
        let (left, height) = (10 + 31 * bar, 120 * count / most);
        let top = 160 - height;
        let _ = writeln!(
            out,
            "<rect class=\"f1\" x=\"{}\" y=\"{top}\" width=\"27\" height=\"{height}\"/>\
             <text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{count}</text>\
             <text class=\"ft\" x=\"{left}\" y=\"178\" text-anchor=\"middle\">{}</text>",
            left + 2,
            left + 15,
            top - 5,
            10 * bar,
        );
    }
    out + "<text class=\"ft\" x=\"320\" y=\"178\" text-anchor=\"middle\">100</text>\
           <line class=\"ax\" x1=\"10\" y1=\"160\" x2=\"320\" y2=\"160\"/></svg></figure>\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grade::samples;
    use fosssim_findings::smallest::SmallestScene;
    use fosssim_grading::{
        GroupGrade, Reason, SceneResult,
        config::{Credit, Hints, Marking, Visibility},
        score,
    };

    fn grade(name: &str, fails: impl Fn(usize) -> Option<String>) -> Grade {
        let marking = Marking {
            points: 20.0,
            credit: Credit::Scenes,
            visibility: Visibility::Visible,
            hints: Hints::Full,
            extra: false,
            speed: None,
        };
        let groups: Vec<GroupGrade> = (0..5)
            .map(|group| {
                let scenes = (0..16).map(|number| {
                    let scene = 16 * group + number;
                    let (verdict, why) = match fails(scene) {
                        Some(words) => (Verdict::WrongAnswer, samples::saying(&words)),
                        None => (Verdict::Accepted, Reason::Right),
                    };
                    (SceneResult::without_run(&format!("Group/a-scene-of-number-{scene}"), 100, verdict, why), false)
                });
                score::group(&format!("Group {group}"), marking, scenes.collect())
            })
            .collect();
        Grade {
            submission: name.to_owned(),
            verdict: groups.iter().map(|group| group.verdict).max().expect("groups"),
            points: groups.iter().map(|group| group.points).sum(),
            max_points: 100.0,
            groups,
            ..samples::good()
        }
    }

    fn page(grades: &[Grade]) -> String {
        ClassPage { grades, passed_over: &[], page: &|grade| format!("reports/{}.html", grade.submission) }.html()
    }

    #[test]
    fn three_hundred_submissions_of_eighty_scenes_stay_small() {
        let fails = |student: usize| {
            move |scene: usize| {
                let words = || format!("{} of 100 steps are wrong, first step {student}: wrong coefficient", scene + 1);
                (scene.is_multiple_of(1 + student % 9)).then(words)
            }
        };
        let grades: Vec<Grade> = (0..300).map(|student| grade(&format!("student-{student}"), fails(student))).collect();
        let html = page(&grades);
        assert!(html.len() < 1_000_000, "{}", html.len());
        assert_eq!(html.matches("<td class=\"heat\"").count(), 300);
        assert!(html.contains("No two submissions make the same mistake."), "each fails in words of its own");
    }

    #[test]
    fn the_smallest_scene_of_a_shared_mistake_is_there_to_be_shown_in_class() {
        let explanations = crate::explain::tests::explanations();
        let mut grades = ["ada", "eve"].map(|name| grade(name, |scene| (scene == 0).then(|| "wrong".to_owned())));
        for (grade, bodies) in grades.iter_mut().zip([3, 2]) {
            grade.groups[0].scenes[0].result.explanations = explanations[..1].to_vec();
            let xml = format!("<scene> of {bodies} </scene>");
            grade.smallest = vec![SmallestScene { xml, bodies, ..samples::smallest(explanations[..1].to_vec()) }];
        }
        let html = page(&grades);
        assert!(html.contains("To show in class: The smallest scene: 2 bodies, 1 step"), "{html}");
        assert!(html.contains("&lt;scene&gt; of 2 ") && !html.contains("&lt;scene&gt; of 3 "));
    }

    #[test]
    fn who_fails_in_the_same_words_is_found_though_no_mistake_is_named() {
        let crash = |scene: usize| (scene > 70).then(|| "the program ended by signal 11".to_owned());
        let grades = [
            grade("ada", |_| None),
            grade("eve", crash),
            grade("<b>kim", crash),
            grade("bob", |_| Some("other".to_owned())),
        ];
        let html = page(&grades);
        let cluster = html.split("class=\"cluster\"").nth(1).expect("one cluster");
        let cluster = &cluster[..cluster.find("</details>").expect("its end")];
        assert!(cluster.contains("the same 9 scenes fail") && cluster.contains("<b>2</b>"), "{cluster}");
        assert!(cluster.contains("eve") && cluster.contains("&lt;b&gt;kim") && !cluster.contains("bob"), "{cluster}");
        assert!(html.contains("<td class=\"num\" data-sort=\"3\">3</td>"), "three fail the last scenes");
        let last = key("Group/a-scene-of-number-75");
        assert!(html.contains(&format!("<a href=\"reports/eve.html#scene-{last}\">Group/a-scene-of-number-75</a>")));
        let bars = html.split("aria-label=\"Points of the class: ").nth(1).expect("a histogram");
        assert!(bars.starts_with("0 to 10 %: 1, ") && bars.contains("90 to 100 %: 1\""), "{bars:.300}");
    }
}
