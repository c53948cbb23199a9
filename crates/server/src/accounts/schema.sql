CREATE TABLE accounts (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    key BLOB NOT NULL UNIQUE CHECK (length(key) = 32),
    name TEXT NOT NULL,
    named_at INTEGER NOT NULL,
    created_at INTEGER NOT NULL,
    seen_at INTEGER NOT NULL
) STRICT;

CREATE TABLE names (
    key TEXT NOT NULL PRIMARY KEY,
    account INTEGER NOT NULL REFERENCES accounts,
    held_until INTEGER
) STRICT;
CREATE INDEX names_of_account ON names (account);

CREATE TABLE settings (
    account INTEGER NOT NULL PRIMARY KEY REFERENCES accounts,
    -- In JSON.
    preferences TEXT NOT NULL,
    configuration TEXT NOT NULL,
    -- Names, in JSON.
    ignored TEXT NOT NULL
) STRICT;

CREATE TABLE bans (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    scope TEXT NOT NULL CHECK (scope IN ('visit', 'talk')),
    kind TEXT NOT NULL CHECK (kind IN ('key', 'name', 'addresses')),
    target TEXT NOT NULL,
    until INTEGER,
    reason TEXT NOT NULL,
    made_by TEXT NOT NULL,
    made_at INTEGER NOT NULL
) STRICT;

CREATE TABLE results (
    account INTEGER NOT NULL REFERENCES accounts,
    level TEXT NOT NULL,
    difficulty TEXT NOT NULL,
    steps INTEGER NOT NULL CHECK (steps >= 0),
    -- In JSON, with the same steps.
    tally TEXT NOT NULL,
    rank TEXT NOT NULL,
    verified_at INTEGER NOT NULL,
    script TEXT NOT NULL,
    PRIMARY KEY (account, level, difficulty)
) STRICT;
CREATE INDEX results_of_board ON results (level, difficulty, steps, verified_at, account);

CREATE TABLE account_rates (
    network TEXT NOT NULL PRIMARY KEY,
    whole_at_ms INTEGER NOT NULL
) STRICT;

-- What the hosts of a cluster tell each other. Times are those of the view clock.
CREATE TABLE leases (
    room TEXT NOT NULL PRIMARY KEY,
    host TEXT,
    epoch INTEGER NOT NULL,
    time_ms INTEGER NOT NULL,
    ends_at INTEGER NOT NULL
) STRICT;

CREATE TABLE visits (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    host TEXT NOT NULL,
    visitor TEXT NOT NULL
) STRICT;
CREATE INDEX visits_of_visitor ON visits (visitor);
CREATE INDEX visits_of_host ON visits (host);

CREATE TABLE hosts (
    name TEXT NOT NULL PRIMARY KEY,
    version TEXT NOT NULL,
    address TEXT NOT NULL,
    load INTEGER NOT NULL,
    seen_at INTEGER NOT NULL
) STRICT;
