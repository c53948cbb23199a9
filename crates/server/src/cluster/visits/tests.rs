//! Hosts that count their visits together, in simulated time.

use tokio::runtime::Builder;
use tokio::task::JoinHandle;

use super::*;
use crate::accounts::worker::Call;

/// Several hosts, and the database that they share.
struct Hosts {
    database: Arc<Mutex<Database>>,
    running: Vec<Running>,
}

struct Running {
    visits: Visits,
    tasks: [JoinHandle<()>; 2],
}

struct Database {
    store: HostStore,
    asked_at: Instant,
    is_away: bool,
}

impl Hosts {
    fn new(count: usize) -> Self {
        let (store, asked_at) = (HostStore::in_memory(), Instant::now());
        let database = Database { store, asked_at, is_away: false };
        let mut hosts = Self { database: Arc::new(Mutex::new(database)), running: Vec::new() };
        (0..count).for_each(|host| hosts.add(host));
        hosts
    }

    /// Adds a host that announces itself.
    fn add(&mut self, host: usize) {
        let (worker, mut queue) = StoreWorker::new(256);
        let notice = HostNotice { name: format!("host {host}"), ..HostNotice::default() };
        let visits = Visits::new(worker, notice);
        let database = Arc::clone(&self.database);
        let announcing = visits.clone();
        let announces = tokio::spawn(async move {
            loop {
                announcing.announce(0);
                sleep(ANNOUNCEMENT_INTERVAL).await;
            }
        });
        let keeps = tokio::spawn(async move {
            while let Some(call) = queue.recv().await {
                locked(&database, |database| database.run(call));
            }
        });
        self.running.push(Running { visits, tasks: [announces, keeps] });
    }

    async fn begin(&self, host: usize, new_visit: NewVisit) -> Result<CountedVisit, VisitRefusal> {
        self.running[host].visits.begin(new_visit).await
    }

    /// Kills a host: its calls no longer reach the database.
    fn kill(&self, host: usize) {
        self.running[host].tasks.iter().for_each(JoinHandle::abort);
    }

    fn set_away(&self, is_away: bool) {
        locked(&self.database, |database| database.is_away = is_away);
    }

    /// The number of visits. Each visitor has one by the key and one by the address.
    fn count(&self) -> i64 {
        locked(&self.database, |database| {
            database.pass();
            let connection = database.store.connection();
            let sql = "SELECT count(*) FROM visits";
            connection.query_row(sql, [], |row| row.get::<_, i64>(0)).unwrap()
        })
    }
}

impl Database {
    fn run(&mut self, call: Call) {
        self.pass();
        if self.is_away {
            let failure = StoreFailure::Away("the database does not answer".into());
            call(&mut HostStore::failing(failure));
        } else {
            call(&mut self.store);
        }
    }

    fn pass(&mut self) {
        let now = Instant::now();
        self.store.pass(now - self.asked_at);
        self.asked_at = now;
    }
}

fn run(test: impl AsyncFnOnce(Hosts)) {
    let runtime = Builder::new_current_thread().enable_time().start_paused(true).build().unwrap();
    runtime.block_on(async { test(Hosts::new(2)).await });
}

fn new_visit(key: u8, last: u8) -> NewVisit {
    let address = IpAddr::from([192, 0, 2, last]);
    NewVisit { key: Some(AccountKey::new([key; 32])), per_key: 1, address, per_address: 2 }
}

const TOO_MANY_KEYS: VisitRefusal = VisitRefusal::TooMany(Refusal::Key);

#[test]
fn keys_and_addresses_are_limited_across_all_hosts() {
    run(async |hosts| {
        let visit = hosts.begin(0, new_visit(1, 1)).await.unwrap();
        let came = Instant::now();
        assert_eq!(hosts.begin(1, new_visit(1, 2)).await.unwrap_err(), TOO_MANY_KEYS);
        assert!(came.elapsed() < ANNOUNCEMENT_INTERVAL * 2, "{:?}", came.elapsed());
        let _other = hosts.begin(1, new_visit(2, 1)).await.unwrap();
        let refusal = VisitRefusal::TooMany(Refusal::Address);
        assert_eq!(hosts.begin(1, new_visit(3, 1)).await.unwrap_err(), refusal);
        // If one limit turns a visitor away, the visit counts against no limit.
        assert_eq!(hosts.count(), 4);
        drop(visit);
        hosts.begin(1, new_visit(1, 1)).await.unwrap();
    });
}

#[test]
fn a_returning_visitor_waits_until_the_killed_host_expires() {
    run(async |hosts| {
        let visit = hosts.begin(0, new_visit(1, 1)).await.unwrap();
        sleep(Duration::from_secs(10)).await;
        hosts.kill(0);
        drop(visit);
        let came = Instant::now();
        let _visit = hosts.begin(1, new_visit(1, 1)).await.unwrap();
        assert!(came.elapsed() < HOST_TIMEOUT + ANNOUNCEMENT_INTERVAL, "{:?}", came.elapsed());
        assert!(came.elapsed() + ANNOUNCEMENT_INTERVAL >= HOST_TIMEOUT, "{:?}", came.elapsed());
    });
}

#[test]
fn visits_that_end_during_an_outage_are_removed_later() {
    run(async |hosts| {
        let visit = hosts.begin(0, new_visit(1, 1)).await.unwrap();
        let other = hosts.begin(0, new_visit(2, 2)).await.unwrap();
        hosts.set_away(true);
        let refusal = hosts.begin(1, new_visit(3, 3)).await.unwrap_err();
        assert!(matches!(refusal, VisitRefusal::NotNow(_)), "{refusal:?}");
        drop(visit);
        sleep(Duration::from_secs(20)).await;
        hosts.set_away(false);
        sleep(ANNOUNCEMENT_INTERVAL * 2).await;
        assert_eq!(hosts.count(), 2);
        hosts.begin(1, new_visit(1, 1)).await.unwrap();
        assert_eq!(hosts.begin(1, new_visit(2, 2)).await.unwrap_err(), TOO_MANY_KEYS);
        drop(other);
    });
}

#[test]
fn a_visitor_who_leaves_before_the_reply_does_not_count() {
    run(async |hosts| {
        let begin = hosts.begin(0, new_visit(1, 1));
        assert!(tokio::time::timeout(Duration::ZERO, begin).await.is_err());
        sleep(Duration::from_millis(1)).await;
        assert_eq!(hosts.count(), 0);
        hosts.begin(1, new_visit(1, 1)).await.unwrap();
    });
}

#[test]
fn a_stopped_host_has_no_visits() {
    run(async |hosts| {
        let visit = hosts.begin(0, new_visit(1, 1)).await.unwrap();
        let host = &hosts.running[0].visits;
        assert_eq!(host.hosts().await.unwrap().len(), 2);
        host.leave().await;
        drop(visit);
        sleep(ANNOUNCEMENT_INTERVAL * 2).await;
        assert_eq!((hosts.count(), host.hosts().await.unwrap().len()), (0, 1));
        hosts.begin(1, new_visit(1, 1)).await.unwrap();
    });
}
