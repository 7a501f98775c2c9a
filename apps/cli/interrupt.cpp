// SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include <csignal>

#include <pthread.h>
#include <unistd.h>

namespace aglow::cli {
namespace {

constexpr int kInterrupted = 130;

sigset_t stopping_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    return signals;
}

}  // namespace

Interrupt::Interrupt() {
    const sigset_t signals = stopping_signals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    waiter_ = std::thread([this] { wait_for_signals(); });
}

Interrupt::~Interrupt() {
    ended_ = true;
    pthread_kill(waiter_.native_handle(), SIGINT);  // wakes sigwait, which reads `ended_`
    waiter_.join();
}

void Interrupt::wait_for_signals() {
    const sigset_t signals = stopping_signals();
    int signal = 0;
    while (sigwait(&signals, &signal) == 0 && !ended_) {
        if (asked_) _exit(kInterrupted);
        asked_ = true;
    }
}

}  // namespace aglow::cli
