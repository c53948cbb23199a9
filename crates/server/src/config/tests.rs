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
fn a_written_configuration_parses_to_itself() -> Result<(), Faults> {
    let mut config = Config { listen: "[::1]:22".parse().unwrap(), ..Config::default() };
    config.admission.startups = 7;
    config.drain = Duration::ZERO;
    config.message = "\"Races\" at 20:00 \\o/".to_owned();
    config.log = "warn,rooms=debug".parse().unwrap();
    config.metrics = Some("127.0.0.1:9464".parse().unwrap());
    config.name = "Mara's \"cellar\"".to_owned();
    config.maps = Some("/srv/maps".into());
    config.proxies =
        ["10.0.0.5", "2001:db8::/32"].map(|it| AddressPrefix::parse(it).unwrap()).into();
    config.web_proxies = vec![AddressPrefix::parse("127.0.0.1").unwrap()];
    config.moderators = vec![AccountKey::new([1; 32]), AccountKey::new([2; 32])];
    assert_eq!(Config::parse(&config.to_string(), "serve.toml")?, config);
    config.standing.pop();
    assert_eq!(Config::parse(&config.to_string(), "serve.toml")?, config);
    config.standing.clear();
    assert_eq!(Config::parse(&config.to_string(), "serve.toml")?, config);
    Ok(())
}

/// The range of a number, as the message of its fault states it.
fn range(key: &str) -> [u64; 2] {
    let faults = faults(&format!("{key} = 99999999999"));
    let range = faults.split("a whole number from ").nth(1).and_then(|it| it.lines().next());
    let (least, most) = range.and_then(|it| it.split_once(" to ")).unwrap();
    [least, most].map(|end| end.parse().unwrap())
}

#[test]
fn each_number_sets_only_its_own_field() -> Result<(), Faults> {
    let default = Config::default();
    for setting in &NUMBERS {
        for value in range(setting.key) {
            let config = Config::parse(&format!("{} = {value}", setting.key), "serve.toml")?;
            assert_eq!(setting.value.write(&config), value.to_string(), "{}", setting.key);
            for other in NUMBERS.iter().filter(|other| other.key != setting.key) {
                assert!(!other.value.differs(&config, &default), "{}", other.key);
            }
            let mut copy = default.clone();
            setting.value.copy(&config, &mut copy);
            assert_eq!(copy, config);
        }
    }
    Ok(())
}

#[test]
fn the_comment_about_the_log_states_its_grammar() {
    assert!(TEXTS.iter().any(|setting| setting.about.ends_with(LogFilter::GRAMMAR)));
}

#[test]
fn all_faults_are_reported_with_their_lines() {
    insta::assert_snapshot!(faults(
        "listen = \"localhost\"\nconnection = 5\nrows = \"many\"\ncolumns = 19\n\
         connections = 1.5\nsilence-seconds = 99999999999999999999\nwhat = 1\n"
    ));
}

#[test]
fn text_faults_are_reported_with_their_lines() {
    insta::assert_snapshot!(faults(
        "message = \"two\\nlines\"\nlog = \"info,conections=warn\"\n\
         [metrics]\nlisten = \"9464\"\nport = 9464\n"
    ));
}

#[test]
fn proxy_faults_are_reported_with_their_lines() {
    insta::assert_snapshot!(faults("proxies = [\"10.0.0.5\", \"10.0.0.0/33\",\n\"proxy\", 5]\n"));
    insta::assert_snapshot!(faults("proxies = \"10.0.0.5\"\n"));
    assert!(faults("web-proxies = [\"proxy\"]\n").contains("write web-proxies = ["));
    insta::assert_snapshot!(faults(&format!("proxies = [{}]\n", "\"10.0.0.5\", ".repeat(65))));
}

#[test]
fn moderator_faults_are_reported_with_their_lines() {
    insta::assert_snapshot!(faults(
        "moderators = [\"mara\", \"SHA256:short\", 7]\nmesage = \"\"\n"
    ));
    insta::assert_snapshot!(faults("moderators = \"mara\"\n"));
    let key = format!("\"{}\", ", AccountKey::new([1; 32]));
    let said = faults(&format!("moderators = [{}]\n", key.repeat(65)));
    assert!(said.contains("there are 65 moderators, and the limit is 64"), "{said}");
}

#[test]
fn room_faults_are_reported_with_their_lines() {
    insta::assert_snapshot!(faults(
        "name = \"\"\nmaps = \"maps\"\n\
         [[room]]\nmode = \"alone\"\n\
         [[room]]\nmode = \"tig\"\ndificulty = \"easy\"\n\
         [[room]]\nlevel = 5\ndifficulty = \"dire\"\n"
    ));
    insta::assert_snapshot!(faults("room = [1]\n"));
    insta::assert_snapshot!(faults(&"[[room]]\n".repeat(33)));
}

#[test]
fn unknown_room_levels_are_reported() {
    let text = "[[room]]\nlevel = \"cellar\"\n[[room]]\nmode = \"race\"\nlevel = \"celar\"\n\
                [[room]]\nlevel = \"moss\"\n";
    let levels = ["cellar", "museum"];
    let faults = Config::check_levels(text, "serve.toml", &levels).unwrap_err();
    insta::assert_snapshot!(faults);
    let rooms = Config::parse(text, "serve.toml").unwrap().standing;
    let levels: Vec<&str> = rooms.iter().map(|room| room.level.as_str()).collect();
    assert_eq!(levels, ["cellar", "celar", "moss"]);
    assert!(Config::check_levels(text, "serve.toml", &levels).is_ok());
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

#[test]
fn a_syntax_error_is_located() {
    insta::assert_snapshot!(faults("listen = \"127.0.0.1:2222\"\nconnections = \n"));
}
