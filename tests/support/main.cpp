// The one test binary: doctest's main, but names of tests may hold commas, and to run no test is an
// error.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include "tests/support/process.h"
#include "tests/support/program.h"
#include "tests/support/seal.h"

namespace {

bool ran_none = false;

struct Reporter : doctest::ConsoleReporter {
    explicit Reporter(const doctest::ContextOptions& options) : ConsoleReporter(options) {}
    void test_case_start(const doctest::TestCaseData& data) override {
        ConsoleReporter::test_case_start(data);
        name_ = data.m_name;
        is_slow_ = std::string(data.m_test_suite).find("slow") != std::string::npos;
        begun_ = seconds();
    }
    void test_case_end(const doctest::CurrentTestCaseStats& stats) override {
        doctest::CurrentTestCaseStats of_processor = stats;  // --duration prints these seconds
        of_processor.seconds = seconds() - begun_;
        ConsoleReporter::test_case_end(of_processor);
        if (is_slow_ || of_processor.seconds <= 10) return;
        std::printf(
            "'%s' takes %.0f s of processor time: beyond 10 s a test belongs into a slow suite\n",
            name_.c_str(), of_processor.seconds);
    }
    void test_run_end(const doctest::TestRunStats& stats) override {
        ConsoleReporter::test_run_end(stats);
        ran_none = stats.numTestCasesPassingFilters == 0;
        if (ran_none) std::fprintf(stderr, "error: no test has this name\n");
    }

private:
    /// Of processor time so far, with that of the programs that tests start.
    static double seconds() {
        double sum = 0;
        for (int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
            rusage used;
            ::getrusage(who, &used);
            sum += processor_seconds(used);
        }
        return sum;
    }

    std::string name_;
    bool is_slow_ = false;
    double begun_ = 0;
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
    std::vector<const char*> pointers;
    for (const std::string& word : words) pointers.push_back(word.c_str());
    int result = doctest::Context(static_cast<int>(pointers.size()), pointers.data()).run();
    return seal(ran_none ? 1 : result);
}
