//! A client that speaks SSH but makes unusual requests.

use std::sync::Arc;

use russh::ChannelMsg;
use russh::client::{self, AuthResult, Handle};
use tokio::runtime::Runtime;

use super::house::House;
use crate::soak::wanderer::Anyone;

async fn connect(house: &House) -> Handle<Anyone> {
    client::connect(Arc::default(), house.address, Anyone).await.unwrap()
}

async fn guest(house: &House) -> Handle<Anyone> {
    let mut client = connect(house).await;
    assert!(client.authenticate_none("guest").await.unwrap().success());
    client
}

fn run(test: impl AsyncFnOnce(&House)) {
    let house = House::open();
    house.beside_another(|| Runtime::new().unwrap().block_on(test(&house)));
    house.assert_answers();
}

#[test]
fn asking_for_no_authentication_twice_makes_a_guest() {
    run(async |house| {
        let mut client = connect(house).await;
        let AuthResult::Failure { remaining_methods, .. } =
            client.authenticate_none("ann").await.unwrap()
        else {
            panic!("keys would never be shown");
        };
        let names: Vec<String> = remaining_methods.iter().map(String::from).collect();
        assert_eq!(names, ["publickey", "keyboard-interactive"]);
        assert!(client.authenticate_none("ann").await.unwrap().success());
    });
}

#[test]
fn a_connection_can_have_only_one_session() {
    run(async |house| {
        let client = guest(house).await;
        let _first = client.channel_open_session().await.unwrap();
        for _ in 0..10 {
            assert!(client.channel_open_session().await.is_err());
        }
        assert!(client.channel_open_direct_tcpip("127.0.0.1", 22, "127.0.0.1", 1).await.is_err());
        assert!(client.channel_open_direct_streamlocal("/tmp/x").await.is_err());
    });
}

#[test]
fn a_session_can_begin_only_once() {
    run(async |house| {
        let client = guest(house).await;
        let mut channel = client.channel_open_session().await.unwrap();
        // The client buffers up to 100 replies.
        for number in 0..40 {
            let value = "x".repeat(1000);
            channel.set_env(true, format!("LC_{}", "A".repeat(number)), value).await.unwrap();
        }
        channel.request_pty(true, "xterm", 0, u32::MAX, 0, 0, &[]).await.unwrap();
        channel.request_pty(true, "vt100", 80, 24, 0, 0, &[]).await.unwrap();
        channel.request_x11(true, false, "MIT-MAGIC-COOKIE-1", "00", 0).await.unwrap();
        channel.request_shell(true).await.unwrap();
        channel.request_shell(true).await.unwrap();
        let mut answers = Vec::new();
        let mut shown = Vec::new();
        while answers.len() < 45 {
            match channel.wait().await.unwrap() {
                ChannelMsg::Success => answers.push(true),
                ChannelMsg::Failure => answers.push(false),
                ChannelMsg::Data { data } => shown.extend_from_slice(&data),
                _ => {}
            }
        }
        assert_eq!(answers.iter().take(40).filter(|is_kept| **is_kept).count(), 16);
        assert_eq!(answers[40..], [true, false, false, true, false]);
        // Its window has a single column.
        while shown.is_empty() {
            if let ChannelMsg::Data { data } = channel.wait().await.unwrap() {
                shown.extend_from_slice(&data);
            }
        }
    });
}

#[test]
fn a_disconnected_client_leaves_nothing_behind() {
    run(async |house| {
        for _ in 0..5 {
            let client = guest(house).await;
            let channel = client.channel_open_session().await.unwrap();
            channel.request_pty(false, "xterm", 80, 24, 0, 0, &[]).await.unwrap();
            channel.request_shell(true).await.unwrap();
            drop(client);
        }
        super::house::wait_until("a session is left", || house.sessions() == 1);
    });
}
