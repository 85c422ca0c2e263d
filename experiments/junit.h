// Results of checks as other programs show them: JUnit XML, and the summary page of a GitHub job.
#pragma once

#include <string>
#include <vector>

namespace framesim {

struct CheckedCase {
  std::string name;
  std::vector<std::string> failures;  // none: passed
};
struct CheckedSuite {
  std::string name;
  std::vector<CheckedCase> cases;
};

// JUnit XML: one <testsuite> each, one <testcase> a case, one <failure> for all that failed in it. No times and no dates: equal
// results, equal bytes. What XML cannot hold (control characters) is '?'.
std::string junit_xml(const std::vector<CheckedSuite>& suites);

// A heading with the counts, and the failed cases as a table.
std::string markdown_summary(const std::string& heading, const std::vector<CheckedSuite>& suites);

// Appends to the file that the environment variable GITHUB_STEP_SUMMARY names, if it is set and not empty. A file that
// cannot be written is a remark on stderr: a check does not fail for its summary.
void append_step_summary(const std::string& markdown);

}  // namespace framesim
