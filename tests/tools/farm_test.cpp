// SPDX-License-Identifier: Apache-2.0
// Runs relief farm: its lines in a shell, with GNU parallel, and with a Slurm of two nodes on this
// machine, which the tests start.
#include "relief/farm.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "support/labels.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

/// A line of bash, outside of the test's process.
ProgramResult bash(const Workplace& workplace, const std::string& line) {
    return test::run_program({"/bin/bash", "-c", "PATH=$PWD/build/release/bin:$PATH\n" + line},
                             workplace / "");
}

/// The models of the bakes; data/ itself must not change.
void copy_models(const Workplace& workplace) {
    bash(workplace, "cp data/urn-high.ply high.ply; cp data/urn-low.obj low.obj; mkdir whole");
}

bool is_installed(const std::string& program) {
    return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

/// Writes a list of jobs.
void write_jobs(const Workplace& workplace, const std::string& name, const json& jobs) {
    json list = json::object();
    list["jobs"] = jobs;
    workplace.write(name, list.dump());
}

/// A bake of a square in shards.
json bake_job(const std::string& output, int shards, const std::string& more = "--samples=4") {
    json job = json::object();
    job["command"] = {"bake", "mesh", "high.ply", "low.obj", output, "--size=96", more};
    job["shards"] = shards;
    return job;
}

TEST(ShellWord, IsOneWordForBash) {
    const Workplace workplace;
    for (const std::string& word :
         {std::string("plain-1.2_3/a:b,c=d+e"), std::string(), std::string("two words"),
          std::string("it's"), std::string("\"$HOME\" `id` $(id) \\"), std::string("-n"),
          std::string("a\nb\n"), std::string("tab\tand\x01\x7f"), std::string("*?[a]{b,c}~!#&;|<>"),
          std::string("caf\xc3\xa9 \xff")}) {
        const std::string shell = shell_word(word);
        EXPECT_EQ(shell.find('\n'), std::string::npos);
        EXPECT_EQ(bash(workplace, "printf '%s|' " + shell).out, word + "|") << shell;
    }
    EXPECT_EQ(shell_line({"a", "b c", "-d"}), "a 'b c' -d");
}

TEST(Farm, PrintsLinesThatGiveTheMapsOfOneRun) {
    const Workplace workplace;
    copy_models(workplace);
    // Names that a shell would expand, split or execute.
    const std::vector<std::string> names = {"it's \"$(touch pwned)\".png", "-rf.png", "a\nb;.png"};
    json jobs = json::array();
    for (std::size_t i = 0; i < names.size(); ++i) {
        jobs.push_back(bake_job("./out/" + names[i], i == 0 ? 3 : 1));
        workplace.write("whole.sh",
                        shell_line({"relief-bake", "mesh", "high.ply", "low.obj",
                                    "./whole/" + names[i], "--size=96", "--samples=4"}));
        ASSERT_EQ(bash(workplace, "bash whole.sh").exit_code, 0);
    }
    write_jobs(workplace, "jobs.json", jobs);
    const ProgramResult lines = bash(workplace, "relief farm jobs.json > lines.sh && cat lines.sh");
    ASSERT_EQ(lines.exit_code, 0) << lines.error;
    EXPECT_EQ(std::ranges::count(lines.out, '\n'), 5 + 1 + 1);
    EXPECT_THAT(lines.out, HasSubstr("\n# When all of these are done:\n"));
    const ProgramResult run = bash(workplace, "bash lines.sh >/dev/null");
    EXPECT_EQ(run.exit_code, 0) << run.error;
    EXPECT_EQ(workplace.run("diff -r whole out").out, "");
    EXPECT_FALSE(std::filesystem::exists(workplace / "pwned"));
    ASSERT_EQ(workplace.run("relief farm jobs.json --clean").exit_code, 0);
    EXPECT_EQ(workplace.run("ls -A | grep relief-farm").out, "");
}

TEST(Farm, DividesListsOfModelsAndAssets) {
    const Workplace workplace;
    const json words = {"mesh",
                        "process",
                        "data/vase.obj",
                        "data/urn-low.obj",
                        "data/urn-high.ply",
                        "-o",
                        "out/models/",
                        "--format",
                        "glb",
                        "--normals",
                        "angle"};
    json job = json::object();
    job["name"] = "models";
    job["command"] = words;
    job["shards"] = 2;
    write_jobs(workplace, "jobs.json", json::array({job}));
    const ProgramResult run =
        bash(workplace, "relief farm jobs.json > lines.sh && bash lines.sh && ls out/models");
    EXPECT_EQ(run.exit_code, 0) << run.error;
    EXPECT_THAT(run.out, HasSubstr("urn-high.glb\nurn-low.glb\nvase.glb\n"));
    // One task for each asset of a file of relief make --job, at most.
    const std::string assets = workplace.run("relief farm data/make-job.json").out;
    EXPECT_EQ(std::ranges::count(assets, '\n'), 2);
    EXPECT_THAT(assets, HasSubstr("make --shard=2/2 --threads=1 --job="));
    const std::string one = workplace.run("relief farm data/make-job.json --shards 1").out;
    EXPECT_THAT(one, Not(HasSubstr("--shard")));
}

TEST(Farm, RefusesWhatItCannotDivide) {
    const Workplace workplace;
    const auto jobs = [&](const std::string& name, const std::string& text) {
        workplace.write(name, text);
        return "farm " + name;
    };
    expect_refusals(
        workplace, "relief", "map.png",
        {{jobs("a.json", "{"), 1, "a.json: "},
         {jobs("b.json", R"({"jobs": []})"), 1, "b.json: /jobs: is empty"},
         {jobs("c.json", R"({"jobs": [{"command": ["view", "a"], "shards": 2}]})"), 1,
          "c.json: /jobs/0/shards: only bake mesh, check, make and mesh process can be divided"},
         {jobs("d.json", R"({"jobs": [{"command": ["farm", "d.json"]}]})"), 1,
          "d.json: /jobs/0/command: must begin with a command of relief"},
         {jobs("e.json", R"({"jobs": [{"command": []}]})"), 1, "e.json: /jobs/0/command: is empty"},
         {jobs("f.json", R"({"jobs": [{"command": ["make"], "shard": 2}]})"), 1, "f.json: "},
         {"farm none.json", 1, "none.json"},
         {"farm data/make-job.json --submit", 2, "--submit, --measure: have no effect"},
         {"farm data/make-job.json --silence 5", 2, "--silence: has no effect without"},
         {"farm data/make-job.json --engine slurm --folder data", 1, "/"},
         {"farm data/make-job.json --clean --folder data", 1, "/"}});
}

/// Bakes out/a.png and out/b.png in one run, into whole/.
void bake_whole(const Workplace& workplace) {
    copy_models(workplace);
    for (const char* name : {"a", "b"}) {
        ASSERT_EQ(
            bash(workplace, fmt::format("relief-bake mesh high.ply low.obj whole/{}.png --size 96 "
                                        "--samples 4",
                                        name))
                .exit_code,
            0);
    }
}

TEST_LABELS(slow);
TEST(FarmOfParallel, RepeatsWhatFailedAndContinuesAfterAnInterruption) {
    if (!is_installed("parallel")) GTEST_SKIP() << "GNU parallel is not installed";
    const Workplace workplace;
    bake_whole(workplace);
    write_jobs(workplace, "jobs.json",
               json::array({bake_job("out/a.png", 16), bake_job("out/b.png", 3)}));
    const std::string line = "relief farm jobs.json --engine parallel --folder 'farm it'\\''s' ";
    ASSERT_EQ(bash(workplace, line).exit_code, 0);
    // The inputs are missing at first.
    ASSERT_EQ(bash(workplace, "mv low.obj low").exit_code, 0);
    const ProgramResult failed =
        bash(workplace, line + "--submit --retries 0 --report report.json");
    EXPECT_EQ(failed.exit_code, 1);
    EXPECT_THAT(failed.error, HasSubstr("job 1 1/16: failed, see "));
    EXPECT_EQ(json::parse(workplace.read("report.json")).at("failed"), 21);
    ASSERT_EQ(bash(workplace, "mv low low.obj").exit_code, 0);
    const ProgramResult done = bash(workplace, line + "--submit --report report.json");
    EXPECT_EQ(done.exit_code, 0) << done.error;
    const json report = json::parse(workplace.read("report.json"));
    EXPECT_EQ(report.at("failed"), 0);
    EXPECT_EQ(report.at("attempts"), 1);
    EXPECT_EQ(report.at("results").size(), 21U);
    EXPECT_EQ(bash(workplace, "diff -r whole out").out, "");
    EXPECT_EQ(bash(workplace, "ls farm*/parts").out, "");
    // Everything is done.
    ASSERT_EQ(bash(workplace, "rm out/a.png").exit_code, 0);
    EXPECT_EQ(bash(workplace, line + "--submit").exit_code, 0);
    EXPECT_FALSE(std::filesystem::exists(workplace / "out/a.png"));
}

TEST_LABELS(slow);
TEST(FarmOfParallel, ContinuesWhenAFullDiskHasSpaceAgain) {
    if (!is_installed("parallel")) GTEST_SKIP() << "GNU parallel is not installed";
    const Workplace workplace;
    bake_whole(workplace);
    ASSERT_EQ(bash(workplace, "mkdir full").exit_code, 0);
    if (bash(workplace, "mount -t tmpfs -o size=150k none full").exit_code != 0)
        GTEST_SKIP() << "file systems cannot be mounted";
    write_jobs(workplace, "jobs.json",
               json::array({bake_job("out/a.png", 16), bake_job("out/b.png", 1)}));
    const std::string line =
        "relief farm jobs.json --engine parallel --folder full/farm --submit --retries 0";
    const ProgramResult failed = bash(workplace, line);
    EXPECT_EQ(failed.exit_code, 1);
    ASSERT_EQ(bash(workplace, "mount -o remount,size=20M full").exit_code, 0);
    const ProgramResult done = bash(workplace, line);
    EXPECT_EQ(done.exit_code, 0) << done.error;
    EXPECT_EQ(bash(workplace, "diff -r whole out").out, "");
    EXPECT_EQ(bash(workplace, "find full/farm/parts -type f; umount full").out, "");
}

/// Puts programs of a Slurm that is not there into PATH: sbatch runs all tasks of an array at once,
/// and squeue says what the file "queue" holds, and fails if it does not exist.
std::string fake_slurm(const Workplace& workplace) {
    std::filesystem::create_directory(workplace / "fake");
    workplace.write("fake/sbatch", R"(#!/bin/bash
number=$((100 + $(ls submitted 2>/dev/null | wc -l)))
mkdir -p submitted && touch submitted/$number
[ ! -e sbatch-fails ] || [ $number -lt 101 ] || exit 1
for word; do
    [[ $word != --array=* ]] || last=${word##*-}
done
for ((task = 1; task <= last; ++task)); do
    [ -e paused ] || SLURM_ARRAY_TASK_ID=$task bash -- "$word" >/dev/null 2>&1
done
echo $number
)");
    workplace.write("fake/squeue", R"(#!/bin/bash
[ ! -e hangs ] || exec sleep 1000
cat queue && echo 99
)");
    bash(workplace, "chmod +x fake/*");
    return "PATH=$PWD/fake:$PATH\n";
}

TEST(FarmOfASilentSlurm, IsGivenUpAndContinues) {
    const Workplace workplace;
    bake_whole(workplace);
    const std::string path = fake_slurm(workplace);
    write_jobs(workplace, "jobs.json",
               json::array({bake_job("out/a.png", 2), bake_job("out/b.png", 1)}));
    const std::string line =
        path + "relief farm jobs.json --engine slurm --folder farm --submit --silence 0.02 ";
    // The controller dies after the arrays were submitted.
    workplace.write("paused", "");
    const ProgramResult silent = bash(workplace, line + "--report report.json");
    EXPECT_EQ(silent.exit_code, 1);
    EXPECT_THAT(silent.error,
                HasSubstr("relief: warning: Slurm does not answer (squeue ended with 1); asking "
                          "again for 0.02 min\n"));
    EXPECT_THAT(silent.error,
                HasSubstr("relief: error: Slurm has not answered for 0.02 min (squeue ended with "
                          "1); tasks go on without relief, and the same command continues\n"));
    EXPECT_THAT(silent.error, Not(HasSubstr("failed, see")));
    const json report = json::parse(workplace.read("report.json"));
    EXPECT_EQ(report.at("failed"), 4);
    EXPECT_EQ(report.at("given_up"), "Slurm has not answered for 0.02 min (squeue ended with 1)");
    // It answers again: the arrays are in the queue, then they have ended.
    workplace.write("queue", "100\n");
    bash(workplace, "rm paused; (sleep 3; rm queue; echo 7 > queue) >/dev/null 2>&1 &");
    const ProgramResult done = bash(workplace, line + "--report report.json");
    EXPECT_EQ(done.exit_code, 0) << done.error;
    EXPECT_EQ(done.error, "");
    EXPECT_EQ(json::parse(workplace.read("report.json")).at("given_up"), nullptr);
    EXPECT_EQ(bash(workplace, "diff -r whole out").out, "");
    EXPECT_EQ(bash(workplace, "ls submitted").out, "100\n101\n102\n103\n");
}

TEST(FarmOfASilentSlurm, KnowsArraysThatWereSubmittedBeforeAFailure) {
    const Workplace workplace;
    bake_whole(workplace);
    const std::string path = fake_slurm(workplace);
    write_jobs(workplace, "jobs.json", json::array({bake_job("out/a.png", 2)}));
    const std::string line =
        path + "relief farm jobs.json --engine slurm --folder farm --submit --silence 0.02 ";
    // The array of the shards is submitted, that of the merge is not.
    workplace.write("sbatch-fails", "");
    workplace.write("paused", "");
    const ProgramResult failed = bash(workplace, line);
    EXPECT_EQ(failed.exit_code, 1);
    EXPECT_THAT(failed.error, HasSubstr("sbatch: failed with 1"));
    EXPECT_EQ(workplace.read("farm/slurm/arrays.txt"), "100\n");
    const ProgramResult silent = bash(workplace, line);
    EXPECT_THAT(silent.error, HasSubstr("Slurm has not answered"));
    EXPECT_EQ(bash(workplace, "ls submitted").out, "100\n101\n");
}

/// A Slurm of two nodes on this machine, without systemd and munge.
class Slurm {
  public:
    explicit Slurm(const Workplace& workplace) : workplace_(workplace) {
        const std::string folder = (workplace / "slurm").string();
        std::filesystem::create_directories(workplace / "slurm/state");
        // Ports of this process, so that two tests do not meet.
        const int port = 20000 + 3 * (static_cast<int>(::getpid()) % 5000);
        workplace.write("slurm/slurm.conf", fmt::format(R"(ClusterName=relief
SlurmctldHost={0}(127.0.0.1)
SlurmctldPort={1}
AuthType=auth/none
CredType=cred/none
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SlurmUser=root
SlurmdUser=root
StateSaveLocation={2}/state
SlurmdSpoolDir={2}/spool-%n
SlurmctldPidFile={2}/controller.pid
SlurmdPidFile={2}/%n.pid
SlurmctldLogFile={2}/controller.log
SlurmdLogFile={2}/%n.log
SchedulerParameters=batch_sched_delay=0,sched_interval=1
KillWait=1
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
NodeName=n1 NodeHostname={0} NodeAddr=127.0.0.1 Port={3} CPUs=2 RealMemory=4000
NodeName=n2 NodeHostname={0} NodeAddr=127.0.0.1 Port={4} CPUs=2 RealMemory=4000
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
)",
                                                        host(), port, folder, port + 1, port + 2));
        setenv("SLURM_CONF", (folder + "/slurm.conf").c_str(), 1);
        bash(workplace, "mkdir -p slurm/state && slurmctld -i; slurmd -N n1; slurmd -N n2");
        wait([&] { return bash(workplace_, "sinfo -h -t idle -o %D").out == "2\n"; });
    }
    ~Slurm() {
        bash(workplace_,
             "scancel --me; sleep 1; for pid in slurm/*.pid; do "
             "kill -9 $(cat $pid); done");
        unsetenv("SLURM_CONF");
    }
    Slurm(const Slurm&) = delete;
    Slurm& operator=(const Slurm&) = delete;

    /// Waits up to a minute.
    template <typename Condition>
    static bool wait(const Condition& condition) {
        for (int i = 0; i < 300; ++i) {
            if (condition()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(200));
        }
        return false;
    }

    static bool is_possible() {
        return is_installed("slurmctld") && is_installed("slurmd") && is_installed("sbatch") &&
               ::geteuid() == 0;
    }

  private:
    static std::string host() {
        std::array<char, 256> name{};
        ::gethostname(name.data(), name.size() - 1);
        const std::string full = name.data();
        return full.substr(0, full.find('.'));
    }

    const Workplace& workplace_;
};

TEST_LABELS(slow);
TEST(FarmOfSlurm, HasTheBytesOfOneRunAlsoIfTasksAreKilledAndANodeIsDrained) {
    if (!Slurm::is_possible()) GTEST_SKIP() << "Slurm is not installed, or this is not root";
    const Workplace workplace;
    bake_whole(workplace);
    const Slurm slurm(workplace);
    write_jobs(workplace, "jobs.json",
               json::array({bake_job("out/a.png", 16), bake_job("out/b.png", 2)}));
    const std::string line = "relief farm jobs.json --engine slurm --folder farm ";
    ASSERT_EQ(bash(workplace, line).exit_code, 0);
    // The first run of the third task is killed in its middle; the fifth drains a node.
    bash(workplace,
         "sed -i '2i [ -e killed ] || { touch killed; kill -9 $$; }' farm/tasks/0/3.sh\n"
         "sed -i '2i scontrol update nodename=n2 state=drain reason=test' farm/tasks/0/5.sh");
    const ProgramResult result = bash(workplace, line + "--submit --measure --report report.json");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("limits of 2 min and 256 MB"));
    EXPECT_EQ(json::parse(workplace.read("report.json")).at("failed"), 0);
    EXPECT_TRUE(std::filesystem::exists(workplace / "killed"));
    EXPECT_THAT(bash(workplace, "sinfo -h -N -o '%N %T'").out, HasSubstr("n2 drained\n"));
    EXPECT_EQ(bash(workplace, "diff -r whole out").out, "");
}

TEST_LABELS(slow);
TEST(FarmOfSlurm, TwoFarmsInOneFolderDoNotDisturbEachOther) {
    if (!Slurm::is_possible()) GTEST_SKIP() << "Slurm is not installed, or this is not root";
    const Workplace workplace;
    bake_whole(workplace);
    const Slurm slurm(workplace);
    write_jobs(workplace, "a.json", json::array({bake_job("out/a.png", 4)}));
    write_jobs(workplace, "b.json", json::array({bake_job("out/b.png", 4)}));
    ProgramResult first, second;
    std::thread other(
        [&] { first = bash(workplace, "relief farm a.json --engine slurm --submit"); });
    second = bash(workplace, "relief farm b.json --engine slurm --submit");
    other.join();
    EXPECT_EQ(first.exit_code, 0) << first.error;
    EXPECT_EQ(second.exit_code, 0) << second.error;
    EXPECT_EQ(bash(workplace, "diff -r whole out").out, "");
}

TEST_LABELS(slow);
TEST(FarmOfSlurm, IsGivenUpWhenTheControllerDiesAndContinuesWhenItIsBack) {
    if (!Slurm::is_possible()) GTEST_SKIP() << "Slurm is not installed, or this is not root";
    const Workplace workplace;
    bake_whole(workplace);
    const Slurm slurm(workplace);
    write_jobs(workplace, "jobs.json",
               json::array({bake_job("out/a.png", 4), bake_job("out/b.png", 1)}));
    const std::string line =
        "relief farm jobs.json --engine slurm --folder farm --submit --silence 0.05 ";
    ASSERT_EQ(bash(workplace, "relief farm jobs.json --engine slurm --folder farm").exit_code, 0);
    // The second task kills the controller in its middle.
    bash(workplace,
         "sed -i '2i [ -e killed ] || { touch killed; kill -9 $(cat slurm/controller.pid); }' "
         "farm/tasks/0/2.sh");
    const ProgramResult silent = bash(workplace, line + "--report report.json");
    EXPECT_EQ(silent.exit_code, 1);
    EXPECT_THAT(silent.error, HasSubstr("relief: warning: Slurm does not answer"));
    EXPECT_THAT(silent.error, HasSubstr("relief: error: Slurm has not answered for 0.05 min"));
    EXPECT_NE(json::parse(workplace.read("report.json")).at("given_up"), nullptr);
    ASSERT_EQ(bash(workplace, "slurmctld").exit_code, 0);
    ASSERT_TRUE(Slurm::wait([&] { return bash(workplace, "squeue --noheader").exit_code == 0; }));
    const ProgramResult done = bash(workplace, line + "--report report.json");
    EXPECT_EQ(done.exit_code, 0) << done.error;
    EXPECT_EQ(json::parse(workplace.read("report.json")).at("failed"), 0);
    EXPECT_EQ(bash(workplace, "diff -r whole out").out, "");
}

TEST_LABELS(slow);
TEST(FarmOfSlurm, ContinuesWhenAFullDiskHasSpaceAgain) {
    if (!Slurm::is_possible()) GTEST_SKIP() << "Slurm is not installed, or this is not root";
    const Workplace workplace;
    bake_whole(workplace);
    ASSERT_EQ(bash(workplace, "mkdir full").exit_code, 0);
    if (bash(workplace, "mount -t tmpfs -o size=200k none full").exit_code != 0)
        GTEST_SKIP() << "file systems cannot be mounted";
    const Slurm slurm(workplace);
    write_jobs(workplace, "jobs.json",
               json::array({bake_job("out/a.png", 16), bake_job("out/b.png", 1)}));
    const std::string line =
        "relief farm jobs.json --engine slurm --folder full/farm --submit --retries 0";
    const ProgramResult failed = bash(workplace, line);
    EXPECT_EQ(failed.exit_code, 1);
    ASSERT_EQ(bash(workplace, "mount -o remount,size=20M full").exit_code, 0);
    const ProgramResult done = bash(workplace, line);
    EXPECT_EQ(done.exit_code, 0) << done.error;
    EXPECT_EQ(bash(workplace, "diff -r whole out").out, "");
    EXPECT_EQ(bash(workplace, "find full/farm/parts -type f; umount full").out, "");
}

}  // namespace
}  // namespace relief::tools
