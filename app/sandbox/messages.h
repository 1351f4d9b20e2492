// Messages to the user at the window.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace plumb {

struct Message {
    enum class Severity { note, warning, error };
    Severity severity = Severity::note;
    std::string text; // may have several lines
    double age = 0;   // s of real time since it was posted
};

// Notes expire after a while; warnings and errors stay until dismissed.
class Messages {
  public:
    static constexpr double note_lifetime = 5; // s
    static constexpr std::size_t most = 50;    // beyond this the oldest are dropped

    void say(Message::Severity severity, std::string text);
    void note(std::string text) { say(Message::Severity::note, std::move(text)); }
    void warn(std::string text) { say(Message::Severity::warning, std::move(text)); }
    void error(std::string text) { say(Message::Severity::error, std::move(text)); }
    void grow_older(double seconds);
    void clear() { messages_.clear(); }
    [[nodiscard]] const std::vector<Message> &all() const { return messages_; } // oldest first
    [[nodiscard]] bool empty() const { return messages_.empty(); }

  private:
    std::vector<Message> messages_;
};

} // namespace plumb
