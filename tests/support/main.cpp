// The one test binary: doctest's main, but names of tests may hold commas, and to run no test is an
// error.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <optional>

#include "tests/support/program.h"
#include "tests/support/work.h"

namespace {

bool ran_none = false, only_counts = false;
unsigned count = 0;  // of tests that are to run

struct Reporter : doctest::ConsoleReporter {
    explicit Reporter(const doctest::ContextOptions& options) : ConsoleReporter(options) {}
    void report_query(const doctest::QueryData& data) override {
        if (only_counts && data.run_stats) {
            count = data.run_stats->numTestCasesPassingFilters;
        } else if (!only_counts) {
            ConsoleReporter::report_query(data);
        }
    }
    void test_run_start() override {
        ConsoleReporter::test_run_start();
        if (count > 20) work_.emplace("tests: " + std::to_string(count), count);
    }
    void test_case_start(const doctest::TestCaseData& data) override {
        ConsoleReporter::test_case_start(data);
        if (work_) work_->next(data.m_name);
    }
    void test_run_end(const doctest::TestRunStats& stats) override {
        work_.reset();
        ConsoleReporter::test_run_end(stats);
        ran_none = stats.numTestCasesPassingFilters == 0;
        if (ran_none) std::fprintf(stderr, "error: no test has this name\n");
    }

private:
    std::optional<Work> work_;
};

/// doctest takes a comma for the end of a name, unless a backslash stands before it.
std::string escape_commas(std::string word) {
    if (!word.starts_with("--test-case=")) return word;
    for (size_t at = 0; (at = word.find(',', at)) != std::string::npos; at += 2) {
        word.insert(at, 1, '\\');
    }
    return word;
}

}  // namespace

REGISTER_REPORTER("tests", 1, Reporter);

int main(int argc, char** argv) {
    program_folder = std::filesystem::path(argv[0]).parent_path();
    std::vector<std::string> words = {argv[0], "--reporters=tests"};
    for (int i = 1; i < argc; i++) words.push_back(escape_commas(argv[i]));
    auto run = [&] {
        std::vector<const char*> pointers;
        for (const std::string& word : words) pointers.push_back(word.c_str());
        return doctest::Context(static_cast<int>(pointers.size()), pointers.data()).run();
    };
    words.push_back("--count");
    only_counts = true;
    run();
    only_counts = false;
    words.pop_back();
    int result = run();
    return ran_none ? 1 : result;
}
