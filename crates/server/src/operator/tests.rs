use std::net::IpAddr;

use proptest::prelude::*;
use tokio::sync::watch;

use super::*;
use crate::accounts::{AddressPrefix, BanTarget, Name};
use crate::visitors::{Notice, SessionId, VisitorRow, Visitors};

fn operator(visitors: &Visitors) -> Operator {
    operator_with(visitors, watch::Sender::default())
}

fn operator_with(visitors: &Visitors, ends: watch::Sender<u32>) -> Operator {
    Operator::new(visitors.clone(), Vec::new, ends, None)
}

fn named(name: &str) -> Target {
    Target::Visitors(BanTarget::Name(Name::kept(name)))
}

fn remove(target: Target, reason: &str, banned: bool) -> AdminRequest {
    AdminRequest::Remove { target, reason: reason.to_owned(), banned, moderator: None }
}

#[tokio::test]
async fn requests_reach_the_visitors_they_name() {
    let (visitors, ends) = (Visitors::default(), watch::Sender::default());
    let operator = operator_with(&visitors, ends.clone());
    let mut ada = visitors.arrive(IpAddr::from([192, 0, 2, 1]), None);
    let ben = visitors.arrive(IpAddr::from([192, 0, 2, 2]), None);
    ada.set_name("Ada");
    ben.set_name("Ben");
    let rows = operator.answer_alone(&AdminRequest::Who).visitors;
    assert_eq!(
        rows.iter().map(|row| row.name.as_ref().map(Name::as_str)).collect::<Vec<_>>(),
        [Some("Ada"), Some("Ben")]
    );

    let say = AdminRequest::Say { text: "\u{1b}[2Jclosing \nsoon".to_owned() };
    assert_eq!(operator.answer_alone(&say), AdminReply::of_count(2));
    assert_eq!(ada.notice().await, Notice::Said("[2Jclosing soon".to_owned()));

    let kick = remove(named("ADA"), "", false);
    assert_eq!(operator.answer_alone(&kick), AdminReply::of_count(1));
    let sentence = "The operator of this host has ended your session.";
    assert_eq!(ada.notice().await, Notice::Removed(sentence.to_owned()));

    let range = BanTarget::Addresses(AddressPrefix::parse("192.0.2.1").unwrap());
    let ban = remove(Target::Visitors(range), "flood\u{7}s", true);
    assert_eq!(operator.answer_alone(&ban), AdminReply::of_count(1));
    let sentence = "You are banned from this host: floods";
    assert_eq!(ada.notice().await, Notice::Removed(sentence.to_owned()));

    assert_eq!(operator.answer_alone(&AdminRequest::Drain), AdminReply::of_count(2));
    assert_eq!(*ends.borrow(), 1);
    let fault = AdminReply::of_fault("this host is not in a cluster");
    assert_eq!(operator.answer_alone(&AdminRequest::Hosts), fault);
}

#[test]
fn the_line_format_is_fixed() {
    let lines = [
        (AdminRequest::Who, r#"{"do":"who"}"#),
        (
            remove(named("Ada"), "spam", true),
            r#"{"do":"remove","target":{"name":"Ada"},"reason":"spam","banned":true}"#,
        ),
        (AdminRequest::Hosts, r#"{"do":"hosts"}"#),
        (AdminRequest::Say { text: "a\nb".to_owned() }, r#"{"do":"say","text":"a\nb"}"#),
    ];
    let tell = r#"{"do":"tell","from":"Ada","to":"Ben","text":"hi"}"#;
    let [from, text] = ["Ada", "hi"].map(str::to_owned);
    let to = Name::kept("Ben");
    let tell = (AdminRequest::Tell { from, to, text }, tell);
    for (request, line) in lines.into_iter().chain([tell]) {
        assert_eq!(serde_json::to_string(&request).unwrap(), line);
        assert_eq!(serde_json::from_str::<AdminRequest>(line).unwrap(), request);
    }
    let count = r#"{"visitors":[],"rooms":[],"hosts":[],"count":2,"remarks":[],"fault":null}"#;
    assert_eq!(serde_json::to_string(&AdminReply::of_count(2)).unwrap(), count);
    let kick = r#"{"do":"remove","target":{"session":"3f9a-7"},"reason":"","banned":false}"#;
    let request = remove(Target::Session(SessionId::parse("3f9a-7").unwrap()), "", false);
    assert_eq!(serde_json::to_string(&request).unwrap(), kick);
    let row =
        r#"{"session":"3f9a-7","name":null,"address":"::1","key":null,"room":null,"seconds":7"#;
    let visitor: VisitorRow = serde_json::from_str(&format!("{row}}}")).unwrap();
    assert_eq!(serde_json::to_string(&visitor).unwrap(), format!("{row},\"host\":null}}"));
    let targets = [
        r#"{"name":7}"#,
        r#"{"key":"SHA256:short"}"#,
        r#"{"address":"192.0.2.1/33"}"#,
        r#"{"session":"7"}"#,
    ];
    let remove = |target| kick.replace(r#"{"session":"3f9a-7"}"#, target);
    let lines = ["", "{}", r#"{"do":"shell"}"#, r#"{"do":"say","text":"a","to":"b"}"#, "null"];
    for line in lines.map(str::to_owned).into_iter().chain(targets.map(remove)) {
        assert!(serde_json::from_str::<AdminRequest>(&line).is_err(), "{line}");
    }
}

proptest! {
    #[test]
    fn no_request_panics(name in ".*", reason in ".*", banned: bool, kind in 0..3) {
        let operator = operator(&Visitors::default());
        let request = match kind {
            0 => remove(named(&name), &reason, banned),
            1 => AdminRequest::Tell { from: reason.clone(), to: Name::kept(&name), text: reason },
            _ => AdminRequest::Say { text: name },
        };
        operator.answer_alone(&request);
    }
}
