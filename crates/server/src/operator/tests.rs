use std::net::IpAddr;
use std::sync::Arc;

use proptest::prelude::*;
use tokio::sync::Notify;

use super::*;
use crate::admin::VisitorRow;
use crate::visitors::{Notice, Visitors};

fn operator(visitors: &Visitors) -> Operator {
    operator_with(visitors, Arc::default())
}

fn operator_with(visitors: &Visitors, drain: Arc<Notify>) -> Operator {
    Operator::new(visitors.clone(), Vec::new, drain, None)
}

fn remove(target: Target, reason: &str, banned: bool) -> AdminRequest {
    AdminRequest::Remove { target, reason: reason.to_owned(), banned, moderator: None }
}

#[tokio::test]
async fn requests_reach_the_visitors_they_name() {
    let (visitors, drain) = (Visitors::default(), Arc::<Notify>::default());
    let operator = operator_with(&visitors, Arc::clone(&drain));
    let mut ada = visitors.arrive(IpAddr::from([192, 0, 2, 1]), None);
    let ben = visitors.arrive(IpAddr::from([192, 0, 2, 2]), None);
    ada.set_name("Ada");
    ben.set_name("Ben");
    let AdminReply::Visitors(rows) = operator.answer_alone(&AdminRequest::Who) else {
        panic!("no rows")
    };
    assert_eq!(
        rows.iter().map(|row| row.name.as_deref()).collect::<Vec<_>>(),
        [Some("Ada"), Some("Ben")]
    );

    let say = AdminRequest::Say { text: "\u{1b}[2Jclosing \nsoon".to_owned() };
    assert_eq!(operator.answer_alone(&say), AdminReply::Count(2));
    assert_eq!(ada.notice().await, Notice::Said("[2Jclosing soon".to_owned()));

    let kick = remove(Target::Name("ADA".to_owned()), "", false);
    assert_eq!(operator.answer_alone(&kick), AdminReply::Count(1));
    let sentence = "The operator of this host has ended your session.";
    assert_eq!(ada.notice().await, Notice::Removed(sentence.to_owned()));

    let ban = remove(Target::Address("192.0.2.1".to_owned()), "flood\u{7}s", true);
    assert_eq!(operator.answer_alone(&ban), AdminReply::Count(1));
    let sentence = "You are banned from this host: floods";
    assert_eq!(ada.notice().await, Notice::Removed(sentence.to_owned()));

    assert_eq!(operator.answer_alone(&AdminRequest::Drain), AdminReply::Count(2));
    drain.notified().await;
    let AdminReply::Fault(sentence) = operator.answer_alone(&AdminRequest::Hosts) else {
        panic!("hosts without a cluster")
    };
    assert_eq!(sentence, "this host is not in a cluster");
}

#[test]
fn invalid_targets_are_refused_with_a_sentence() {
    let operator = operator(&Visitors::default());
    for target in [
        Target::Name("\u{1b}".to_owned()),
        Target::Key("SHA256:short".to_owned()),
        Target::Address("192.0.2.1/33".to_owned()),
        Target::Session("7".to_owned()),
    ] {
        let reply = operator.answer_alone(&remove(target.clone(), "", false));
        assert!(matches!(reply, AdminReply::Fault(_)), "{target:?}");
    }
}

#[test]
fn the_line_format_is_fixed() {
    let lines = [
        (AdminRequest::Who, r#"{"do":"who"}"#),
        (
            remove(Target::Name("Ada".to_owned()), "spam", true),
            r#"{"do":"remove","target":{"name":"Ada"},"reason":"spam","banned":true}"#,
        ),
        (AdminRequest::Hosts, r#"{"do":"hosts"}"#),
        (AdminRequest::Say { text: "a\nb".to_owned() }, r#"{"do":"say","text":"a\nb"}"#),
    ];
    let tell = r#"{"do":"tell","from":"Ada","to":"Ben","text":"hi"}"#;
    let [from, to, text] = ["Ada", "Ben", "hi"].map(str::to_owned);
    let tell = (AdminRequest::Tell { from, to, text }, tell);
    for (request, line) in lines.into_iter().chain([tell]) {
        assert_eq!(serde_json::to_string(&request).unwrap(), line);
        assert_eq!(serde_json::from_str::<AdminRequest>(line).unwrap(), request);
    }
    assert_eq!(serde_json::to_string(&AdminReply::Count(2)).unwrap(), r#"{"count":2}"#);
    let kick = r#"{"do":"remove","target":{"session":"3f9a-7"},"reason":"","banned":false}"#;
    let request = remove(Target::Session("3f9a-7".to_owned()), "", false);
    assert_eq!(serde_json::to_string(&request).unwrap(), kick);
    let row =
        r#"{"session":"3f9a-7","name":null,"address":"::1","key":null,"room":null,"seconds":7"#;
    let visitor: VisitorRow = serde_json::from_str(&format!("{row}}}")).unwrap();
    assert_eq!(serde_json::to_string(&visitor).unwrap(), format!("{row},\"host\":null}}"));
    for line in ["", "{}", r#"{"do":"shell"}"#, r#"{"do":"say","text":"a","to":"b"}"#, "null"] {
        assert!(serde_json::from_str::<AdminRequest>(line).is_err(), "{line}");
    }
}

proptest! {
    #[test]
    fn no_request_panics(name in ".*", reason in ".*", banned: bool, kind in 0..6) {
        let operator = operator(&Visitors::default());
        let request = match kind {
            0 => remove(Target::Name(name), &reason, banned),
            1 => remove(Target::Key(name), &reason, banned),
            2 => remove(Target::Address(name), &reason, banned),
            3 => remove(Target::Session(name), &reason, banned),
            4 => AdminRequest::Tell { from: reason.clone(), to: name, text: reason },
            _ => AdminRequest::Say { text: name },
        };
        operator.answer_alone(&request);
    }
}
