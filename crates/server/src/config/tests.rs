use super::*;
use cellcaster::fault::Faults;

fn faults(text: &str) -> String {
    Config::parse(text, "serve.toml").unwrap_err().to_string()
}

#[test]
fn an_empty_file_is_the_default() -> Result<(), Faults> {
    assert_eq!(Config::parse("", "serve.toml")?, Config::default());
    Ok(())
}

#[test]
fn each_number_sets_a_field_of_its_own_within_its_range() -> Result<(), Faults> {
    const NUMBERS: [(&str, [u32; 2]); 28] = [
        ("connections", [1, 100_000]),
        ("connections-per-address", [1, 100_000]),
        ("connections-per-key", [1, 1000]),
        ("startups", [1, 10_000]),
        ("failures", [2, 1_000_000]),
        ("forget-seconds", [1, 86_400]),
        ("accounts-per-hour", [1, 1_000_000]),
        ("accounts-at-once", [1, 1_000_000]),
        ("handshake-seconds", [1, 600]),
        ("login-seconds", [1, 3600]),
        ("login-bytes", [8192, 16 << 20]),
        ("bytes-per-second", [1024, 1 << 30]),
        ("silence-seconds", [2, 3600]),
        ("stall-seconds", [2, 86_400]),
        ("columns", [20, 2048]),
        ("rows", [10, 1024]),
        ("drain-seconds", [0, 3600]),
        ("rooms", [2, 10_000]),
        ("watchers", [0, 10_000]),
        ("web-watchers", [1, 10_000]),
        ("web-watchers-per-address", [1, 10_000]),
        ("empty-room-seconds", [0, 86_400]),
        ("idle-room-minutes", [2, 1440]),
        ("idle-lobby-minutes", [2, 1440]),
        ("frames-per-second", [5, 60]),
        ("player-bytes-per-second", [0, 1 << 30]),
        ("recordings-megabytes", [1, 1 << 20]),
        ("recordings-days", [1, 3650]),
    ];
    let mut seen = vec![format!("{:?}", Config::default())];
    for (key, ends) in NUMBERS {
        for value in ends {
            let config = format!("{:?}", Config::parse(&format!("{key} = {value}"), "serve.toml")?);
            assert!(!seen.contains(&config), "{key} = {value}");
            seen.push(config);
        }
        for value in [i64::from(ends[0]) - 1, i64::from(ends[1]) + 1] {
            let fault = faults(&format!("{key} = {value}"));
            let [least, most] = ends;
            assert!(fault.contains(&format!("a whole number from {least} to {most}")), "{fault}");
        }
    }
    Ok(())
}

#[test]
fn a_fault_is_reported_with_its_line() {
    let key = format!("\"{}\", ", AccountKey::new([1; 32]));
    let texts = [
        "listen = \"localhost\"\n",
        "message = \"Welcome\"\nconnection = 5\n",
        "rows = \"many\"\n",
        "columns = 19\n",
        "connections = 1.5\n",
        "silence-seconds = 99999999999999999999\n",
        "message = \"two\\nlines\"\n",
        "name = \"\"\n",
        "maps = \"maps\"\n",
        "log = \"info,conections=warn\"\n",
        "[metrics]\nlisten = \"9464\"\n",
        "[metrics]\nport = 9464\n",
        "proxies = [\"10.0.0.5\", \"10.0.0.0/33\"]\n",
        "web-proxies = \"10.0.0.5\"\n",
        "moderators = [\"mara\"]\n",
        "[[room]]\nmode = \"alone\"\n",
        "[[room]]\ndificulty = \"easy\"\n",
        "[[room]]\nmode = \"race\"\ndifficulty = \"dire\"\n",
        "[[room]]\nlevel = 5\n",
        "room = [1]\n",
        "connections = \n",
    ];
    insta::assert_snapshot!(texts.map(faults).join("\n"));
    for (list, limit) in [("proxies", 64), ("moderators", 64)] {
        let element = if list == "proxies" { "\"10.0.0.5\", " } else { &key };
        let said = faults(&format!("{list} = [{}]\n", element.repeat(65)));
        let sentence = format!("the list has 65 entries, and the limit is {limit}");
        assert!(said.contains(&sentence), "{said}");
    }
    assert!(faults(&"[[room]]\n".repeat(33)).contains("there are 33 standing rooms"));
}

#[test]
fn texts_and_lists_are_read() -> Result<(), Faults> {
    let key = AccountKey::new([1; 32]);
    let text = format!(
        "listen = \"[::1]:22\"\nname = \"Mara's\"\nmessage = \"Races\"\nlog = \"warn,rooms=debug\"\n\
         maps = \"/srv/maps\"\nproxies = [\"10.0.0.5\", \"2001:db8::/32\"]\nweb = \"127.0.0.1:8080\"\n\
         web-proxies = [\"127.0.0.1\"]\nmoderators = [\"{key}\"]\nroom = []\n\
         [metrics]\nlisten = \"127.0.0.1:9464\"\n"
    );
    let prefix = |text| AddressPrefix::parse(text).unwrap();
    let expected = Config {
        listen: "[::1]:22".parse().unwrap(),
        name: "Mara's".to_owned(),
        message: "Races".to_owned(),
        log: "warn,rooms=debug".parse().unwrap(),
        maps: Some("/srv/maps".into()),
        proxies: ["10.0.0.5", "2001:db8::/32"].map(prefix).into(),
        web: Some("127.0.0.1:8080".parse().unwrap()),
        web_proxies: vec![prefix("127.0.0.1")],
        moderators: vec![key],
        standing: Vec::new(),
        metrics: Some("127.0.0.1:9464".parse().unwrap()),
        ..Config::default()
    };
    assert_eq!(Config::parse(&text, "serve.toml")?, expected);
    Ok(())
}

#[test]
fn unknown_room_levels_are_reported() {
    let text = "[[room]]\nlevel = \"cellar\"\n[[room]]\nmode = \"race\"\nlevel = \"celar\"\n\
                [[room]]\nlevel = \"moss\"\n";
    let levels = ["cellar", "museum"];
    let config = Config::parse(text, "serve.toml").unwrap();
    let faults = config.check_levels(text, "serve.toml", &levels).unwrap_err();
    insta::assert_snapshot!(faults);
    let rooms = Config::parse(text, "serve.toml").unwrap().standing;
    let levels: Vec<&str> = rooms.iter().map(|room| room.level.get_ref().as_str()).collect();
    assert_eq!(levels, ["cellar", "celar", "moss"]);
    assert!(config.check_levels(text, "serve.toml", &levels).is_ok());
}

#[test]
fn a_running_server_keeps_fixed_settings() {
    let live = LiveConfig::new(Config::default());
    let mut seen = live.subscribe();
    let mut wanted = Config { message: "Welcome".to_owned(), ..Config::default() };
    assert!(live.replace(wanted.clone()).is_empty());
    assert!(seen.has_changed().unwrap());
    assert_eq!(seen.borrow_and_update().message, "Welcome");
    wanted.listen = "[::1]:22".parse().unwrap();
    wanted.metrics = Some("127.0.0.1:9464".parse().unwrap());
    wanted.rows = 100;
    wanted.empty_room = Duration::ZERO;
    wanted.maps = Some("/srv/maps".into());
    wanted.recordings_days = 7;
    wanted.web = Some("127.0.0.1:8080".parse().unwrap());
    let fixed = ["listen", "metrics.listen", "maps", "web", "recordings-days"];
    assert_eq!(live.replace(wanted), fixed);
    let config = live.get();
    assert_eq!((config.rows, config.listen), (100, Config::default().listen));
    assert_eq!((config.metrics, config.maps.as_ref()), (None, None));
    assert_eq!(config.empty_room, Duration::ZERO);
}
