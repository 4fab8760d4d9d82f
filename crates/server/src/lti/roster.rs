//! The members of a platform's course, as the platform lists them (NRPS 2).
use super::{
    Client, LtiPerson, Platform, ServiceFault,
    client::{ServiceRequest, scope},
    message::{find_role, join_name},
};
use crate::db::Database;
use serde::Deserialize;

/// The maximum number of pages that a list of members may have.
const MAX_PAGES: usize = 500;
const MAX_MEMBERS: usize = 50_000;

/// The media type of a page of members.
const MEDIA_TYPE: &str = "application/vnd.ims.lti-nrps.v2.membershipcontainer+json";

#[derive(Deserialize)]
struct RosterPage {
    members: Vec<Member>,
}

#[derive(Deserialize)]
struct Member {
    user_id: String,
    #[serde(default)]
    roles: Vec<String>,
    status: Option<String>,
    name: Option<String>,
    given_name: Option<String>,
    family_name: Option<String>,
    email: Option<String>,
}

/// Reads all pages of the members of a course.
///
/// # Errors
///
/// Fails if the platform reports an error, or its answer is invalid. No members are returned then, not even those of
/// earlier pages.
pub async fn fetch(
    client: &Client,
    database: &Database,
    platform: &Platform,
    url: &str,
) -> Result<Vec<LtiPerson>, ServiceFault> {
    let mut members = Vec::new();
    let mut next = Some(url.to_owned());
    for _ in 0..MAX_PAGES {
        let Some(url) = next else { return Ok(members) };
        let request = ServiceRequest { url, accept: MEDIA_TYPE, body: None };
        let answer = client.call(database, platform, scope::MEMBERS_SCOPE, &request).await?;
        let page: RosterPage = answer.read("the list of members")?;
        members.extend(page.members.into_iter().filter_map(to_person));
        if members.len() > MAX_MEMBERS {
            break;
        }
        next = answer.link.as_deref().and_then(next_page);
    }
    Err(ServiceFault::Rejected(format!("the roster is longer than {MAX_PAGES} pages or {MAX_MEMBERS} members")))
}

fn to_person(member: Member) -> Option<LtiPerson> {
    if member.user_id.is_empty() || member.user_id.len() > 255 {
        return None;
    }
    let is_active = member.status.as_deref().is_none_or(|status| status == "Active");
    Some(LtiPerson {
        subject: member.user_id,
        name: join_name(member.name, [member.given_name, member.family_name]),
        email: member.email,
        role: find_role(&member.roles).filter(|_| is_active),
    })
}

/// Returns the URL of the next page according to the header `Link` (RFC 8288).
fn next_page(header: &str) -> Option<String> {
    let mut rest = header;
    while let Some((_, after)) = rest.split_once('<') {
        let (url, after) = after.split_once('>')?;
        // The parameters end where the next link begins, with a bracket.
        let (parameters, further) = after.split_at(after.find('<').unwrap_or(after.len()));
        let is_next = parameters.split([';', ',']).any(|parameter| {
            parameter.split_once('=').is_some_and(|(name, value)| {
                name.trim().eq_ignore_ascii_case("rel")
                    && value.trim().trim_matches('"').split(' ').any(|word| word.eq_ignore_ascii_case("next"))
            })
        });
        if is_next {
            return Some(url.to_owned());
        }
        rest = further;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_next_page_is_found_in_the_header() {
        for (header, next) in [
            (r#"<https://a/2>; rel="next""#, Some("https://a/2")),
            (r#"<https://a/?p=2;x,y>; rel=next"#, Some("https://a/?p=2;x,y")),
            (r#"<https://a/1>; rel="first", <https://a/2>; title="a"; rel="next last""#, Some("https://a/2")),
            (r#"<https://a/1>; rel="prev", <https://a/9>; rel="differences""#, None),
            ("", None),
            ("<https://a/2", None),
        ] {
            assert_eq!(next_page(header).as_deref(), next, "{header}");
        }
    }
}
