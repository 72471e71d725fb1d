#include "service/store/job_table.h"

#include "service/http/http_message.h"
#include "service/jobs/job_record.h"

namespace afterglow {

JobTable::JobTable(Database& database) : database_(database) {
    database_.change("DELETE FROM frames WHERE job NOT IN (SELECT id FROM jobs)");
}

std::vector<Job> JobTable::load() {
    std::vector<Job> jobs;
    for (const Row& row : database_.ask("SELECT body FROM jobs ORDER BY number"))
        jobs.push_back(job_of_record(parse_json(as_text(row[0]), "job record")));
    return jobs;
}

void JobTable::add(const Job& job) {
    database_.change("INSERT INTO jobs (id, body) VALUES (?1, ?2)", {job.id, dump(to_record(job))});
}

void JobTable::update(const Job& job) {
    database_.change("UPDATE jobs SET body = ?2 WHERE id = ?1", {job.id, dump(to_record(job))});
}

void JobTable::remove(const std::string& id) {
    database_.together([&] {
        database_.change("DELETE FROM frames WHERE job = ?1", {id});
        database_.change("DELETE FROM jobs WHERE id = ?1", {id});
    });
}

}  // namespace afterglow
