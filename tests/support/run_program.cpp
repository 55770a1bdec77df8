#include "support/run_program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>
#include <wordexp.h>

#include <cstring>
#include <mutex>
#include <vector>

#include "lobelia/app/app.h"

extern "C" __attribute__((weak)) void __lsan_do_leak_check();  // there with AddressSanitizer

namespace lobelia::test {
namespace {

constexpr char kLeaks[] = ".leaks";

void redirect(const std::string& file, int flags, int to) {
  const int fd = open(file.c_str(), flags, 0666);
  if (fd < 0 || dup2(fd, to) < 0) _exit(126);
  close(fd);
}

[[noreturn]] void runWords(std::vector<std::string> words, const std::string& out,
                           const std::string& err) {
  redirect("/dev/null", O_RDONLY, STDIN_FILENO);
  redirect(out, O_WRONLY | O_CREAT | O_TRUNC, STDOUT_FILENO);
  redirect(err, O_WRONLY | O_CREAT | O_TRUNC, STDERR_FILENO);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int code = app::run(static_cast<int>(words.size()), argv.data());
  std::fflush(nullptr);
  if (__lsan_do_leak_check) {
    // Speaks of the threads that libraries started when they were loaded, too: forks have none.
    redirect(err + kLeaks, O_WRONLY | O_CREAT | O_TRUNC, STDERR_FILENO);
    __lsan_do_leak_check();  // ends the process when it finds something
  }
  _exit(code);  // exit() would wait for threads of libraries, which a fork does not have
}

// A request: the files for both streams and the words, each ended by a zero. The answer: the status
// as waitpid() has it.
[[noreturn]] void serve(int fd) {
  std::vector<char> request;
  for (;;) {
    char none = 0;
    const ssize_t size = recv(fd, &none, 1, MSG_PEEK | MSG_TRUNC);  // of the whole request
    if (size <= 0) _exit(0);
    request.resize(static_cast<size_t>(size));
    if (recv(fd, request.data(), request.size(), 0) != size) _exit(1);
    std::vector<std::string> words;
    for (const char* p = request.data(); p < request.data() + size; p += words.back().size() + 1)
      words.emplace_back(p);
    const pid_t child = fork();
    if (child == 0) {
      close(fd);
      runWords({words.begin() + 2, words.end()}, words[0], words[1]);
    }
    int status = 126 << 8;
    if (child > 0) waitpid(child, &status, 0);
    if (send(fd, &status, sizeof status, MSG_NOSIGNAL) < 0) _exit(0);
  }
}

// Forked before any test has run, so that it is as the program is when it starts, but for the
// threads of libraries.
class Server : public testing::Environment {
 public:
  void SetUp() override {
    int ends[2];
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends), 0);
    std::fflush(nullptr);
    process_ = fork();
    ASSERT_GE(process_, 0);
    if (process_ == 0) {
      close(ends[0]);
      serve(ends[1]);
    }
    close(ends[1]);
    socket_ = ends[0];
  }
  void TearDown() override {
    if (socket_ < 0) return;
    close(socket_);
    socket_ = -1;
    waitpid(process_, nullptr, 0);
  }
  // False when there is no answer.
  bool run(const std::string& request, int& status) {
    const std::lock_guard lock(mutex_);
    return socket_ >= 0 && send(socket_, request.data(), request.size(), MSG_NOSIGNAL) >= 0 &&
           recv(socket_, &status, sizeof status, 0) == sizeof status;
  }

 private:
  std::mutex mutex_;
  int socket_ = -1;
  pid_t process_ = -1;
};

Server* const server = [] {
  auto* made = new Server;
  testing::AddGlobalTestEnvironment(made);  // which owns it
  return made;
}();

// As a shell splits them; empty for what only a shell can do.
std::vector<std::string> split(const std::string& arguments) {
  std::vector<std::string> words;
  wordexp_t found;
  if (wordexp(arguments.c_str(), &found, WRDE_NOCMD) != 0) return words;
  words.emplace_back(LOBELIA_PROGRAM);
  words.insert(words.end(), found.we_wordv, found.we_wordv + found.we_wordc);
  wordfree(&found);
  return words;
}

}  // namespace

ProgramResult runProgram(const std::string& arguments) {
  const TemporaryFolder folder;
  const std::string out = folder / "out", err = folder / "err";
  const std::vector<std::string> words = split(arguments);
  std::string request = out + '\0' + err + '\0';
  for (const std::string& word : words) request += word + '\0';
  int status = 0;
  if (words.empty() || !server->run(request, status)) return runProgramInShell(arguments);
  ProgramResult result{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
                       readText(out), readText(err)};
  const std::string leaks = readText(err + kLeaks);
  if (leaks.find("ERROR: ") != std::string::npos) result.err += leaks;
  return result;
}

ProgramResult runProgramInShell(const std::string& arguments) {
  const TemporaryFolder folder;
  const std::string command = std::string(LOBELIA_PROGRAM) + " " + arguments + " >" +
                              (folder / "out") + " 2>" + (folder / "err") + " </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
          readText(folder / "out"), readText(folder / "err")};
}

}  // namespace lobelia::test
