// Signals that end a program, and how poinsot ends by them: with status 128 + n, and no half-written file.
//
// While there is something to keep (a Deferred exists) a signal asks what is being computed to come to an end
// (core/interruption.h) and the command keeps it; at other times the program ends at once. Who insists with a second
// Ctrl-C a second later ends it at once in any case.
#pragma once

#include <string>

namespace poinsot::app {

// Once, before anything else. Signals that are ignored (nohup) stay so.
void catch_signals();

class Deferred {
 public:
  Deferred();
  ~Deferred();
  Deferred(const Deferred&) = delete;
  Deferred& operator=(const Deferred&) = delete;
};

int caught_signal();        // while deferred; 0: none
std::string signal_text();  // of it: "interrupted by SIGINT"
int signal_status();        // the exit status by it

}  // namespace poinsot::app
