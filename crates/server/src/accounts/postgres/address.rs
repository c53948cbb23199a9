//! The address of a database, from which no password comes to light.

use std::time::Duration;

use tokio_postgres::Config;
use tokio_postgres::config::{Host, SslMode};

use super::PATIENCE;
use super::tls::Tls;
use crate::accounts::StoreFailure;

/// How a database is reached.
pub(crate) struct Address {
    pub(crate) config: Config,
    /// `None` where the connection is not encrypted.
    pub(crate) tls: Option<Tls>,
    /// The server and the database, to name in sentences.
    pub(crate) shown: String,
}

impl Address {
    pub(crate) fn parse(text: &str) -> Result<Self, StoreFailure> {
        let mut config: Config = text.parse().map_err(|_| no_address())?;
        let host = host(&config).ok_or_else(no_address)?;
        let database = config.get_dbname().or(config.get_user()).unwrap_or("").to_owned();
        // A password with an @ that is not written as %40 is cut there, and its end taken for the host.
        if [&host, &database].iter().any(|part| part.contains(['@', ':'])) {
            return Err(no_address());
        }
        let is_local = host.starts_with('/');
        let is_encrypted = config.get_ssl_mode() == SslMode::Require && !is_local;
        let tls = is_encrypted.then(Tls::of_system).transpose()?;
        if tls.is_none() {
            config.ssl_mode(SslMode::Disable);
        }
        if config.get_application_name().is_none() {
            config.application_name("cellcaster");
        }
        config.connect_timeout(PATIENCE).tcp_user_timeout(PATIENCE);
        config.keepalives_idle(Duration::from_secs(30));
        let shown = format!("the database {database:?} at {host}");
        Ok(Self { config, tls, shown })
    }
}

/// The first server of an address; `None` if there is none.
fn host(config: &Config) -> Option<String> {
    let address = config.get_hostaddrs().first().map(ToString::to_string);
    address.or_else(|| match config.get_hosts().first()? {
        Host::Tcp(name) => Some(name.clone()),
        #[cfg(unix)]
        Host::Unix(path) => Some(path.display().to_string()),
    })
}

fn no_address() -> StoreFailure {
    StoreFailure::new(
        "the store is no address such as postgres://USER:PASSWORD@HOST:PORT/DATABASE; in a password, \
         %40 stands for @, %2F for / and %25 for %",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_names_its_server_and_its_database() {
        for (text, shown) in [
            ("postgres://ada:geheim@db.example.org/games", "\"games\" at db.example.org"),
            ("postgresql://ada:geheim@192.0.2.7:5433", "\"ada\" at 192.0.2.7"),
            ("postgres://ada@%2Frun%2Fpostgresql/games?sslmode=disable", "at /run/postgresql"),
            ("postgres://ada:ge%40heim@host/games?sslmode=prefer", "\"games\" at host"),
        ] {
            let address = Address::parse(text).unwrap();
            assert!(address.shown.contains(shown), "{}", address.shown);
            assert!(!address.shown.contains("heim"), "{}", address.shown);
        }
    }

    #[test]
    fn what_is_no_address_is_refused_without_a_word_of_it() {
        for text in [
            "postgres://",
            "postgres:///games",
            "postgres://ada:geheim@host:port/games",
            "postgres://ada:ge@heim@host/games",
            "postgres://ada:ge@heim/heim@host/games",
            "postgres://ada:ge?heim=1@host/games?geheim=2",
            "postgres://ada:geheim@host/games?sslmode=geheim",
        ] {
            let Err(failure) = Address::parse(text) else { panic!("{text}") };
            let sentence = failure.to_string();
            assert!(!sentence.contains("heim") && sentence.lines().count() == 1, "{sentence}");
        }
    }
}
