// What a scene file defines for its expressions: its parameters and its tables.
//
// Each is read when an expression first asks for it, so that they may use one another in any order; one that comes to
// need itself is an error.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/expression.h"
#include "core/json_document.h"

namespace poinsot {

class Definitions final : public ExpressionNames {
 public:
  // Of a document that stays while this is used. Reads all there is. Throws InputError.
  explicit Definitions(const JsonDocument& document);

  std::optional<double> parameter(std::string_view name) override;
  std::shared_ptr<const Spline> table(std::string_view name) override;
  std::string listed() const override;

  std::map<std::string, double> values() const;  // of all parameters
  int asked() const { return asked_; }           // how often an expression has called anything by name
  // "parameter 'l' is used nowhere", of each that no expression has asked for.
  std::vector<std::string> unused() const;

 private:
  template <class Value>
  struct Entry {
    enum { unread, being_read, read } state = unread;
    bool used = false;
    Value value{};
  };
  template <class Value>
  using Entries = std::map<std::string, Entry<Value>, std::less<>>;

  template <class Value>
  void declare(const char* section, const char* what, Entries<Value>& entries);
  template <class Value, class Read>
  void resolve(const char* section, const std::string& name, Entry<Value>& entry, Read read);
  void resolve(const std::string& name, Entry<double>& entry);
  void resolve(const std::string& name, Entry<std::shared_ptr<const Spline>>& entry);

  JsonValue root_;
  Entries<double> parameters_;
  Entries<std::shared_ptr<const Spline>> tables_;
  std::vector<std::string> being_read_;  // outermost first
  int asked_ = 0;
};

}  // namespace poinsot
