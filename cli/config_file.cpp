#include "cli/config_file.h"

#include <istream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "core/base/text.h"
#include "core/job/yaml_tree.h"

namespace hyades::cli {
namespace {

[[noreturn]] void refuse(const core::SourceLocation& where, const std::string& message) {
  throw CLI::ConfigError(core::Diagnostic{where, message}.to_string(), CLI::ExitCodes::ConfigError);
}

/// A reader of CLI11's that hands all it has read to the options itself, because it alone knows
/// where each value stands.
class YamlConfig final : public CLI::Config {
 public:
  explicit YamlConfig(CLI::App& app) : app_(app) {}

  std::string to_config(const CLI::App*, bool, bool, std::string) const override { return {}; }

  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override {
    const auto file = app_.get_config_ptr()->as<std::string>();
    std::string text;
    for (char letter = 0; text.size() <= core::kMaxYamlBytes && input.get(letter);) text += letter;
    core::Diagnostics diagnostics;
    const core::YamlPtr root = core::parse_yaml(text, file, diagnostics);
    if (!diagnostics.empty()) {
      const core::Diagnostic& first = diagnostics.list().front();
      refuse(first.where, first.message);
    }
    if (root->kind == core::YamlNode::Kind::null) return {};
    if (root->kind != core::YamlNode::Kind::map) {
      refuse(root->where, "expected options by their names, such as 'threads: 8', but this is " +
                              core::describe(*root));
    }
    for (const core::YamlEntry& entry : root->map) set(entry);
    return {};
  }

 private:
  void set(const core::YamlEntry& entry) const {
    CLI::Option* option = app_.get_option_no_throw("--" + entry.key);
    if (option == nullptr || !option->get_configurable()) {
      std::vector<std::string> names;
      for (const CLI::Option* known : app_.get_options()) {
        if (!known->get_configurable()) continue;
        for (const std::string& name : known->get_lnames()) names.push_back(name);
      }
      refuse(entry.key_where,
             "there is no option '" + entry.key + "'" + core::did_you_mean(entry.key, names));
    }
    const std::vector<std::string> values = values_of(entry, *option);
    if (!option->empty()) return;  // the command line goes first
    try {
      if (option->get_expected_min() == 0) {
        option->add_result(option->get_flag_value(entry.key, values.front()));
      } else {
        option->add_result(values);
        option->run_callback();
      }
    } catch (const CLI::ParseError& error) {
      refuse(entry.value->where, in_our_words(app_, error));
    }
  }

  static std::vector<std::string> values_of(const core::YamlEntry& entry,
                                            const CLI::Option& option) {
    using Kind = core::YamlNode::Kind;
    const core::YamlNode& node = *entry.value;
    const bool is_flag = option.get_expected_min() == 0;
    if (is_flag && (node.kind != Kind::scalar || node.quoted ||
                    (node.scalar != "true" && node.scalar != "false"))) {
      refuse(node.where, entry.key + ": expected true or false, but this is " + describe(node));
    }
    if (node.kind == Kind::scalar) return {node.scalar};
    const bool many = option.get_items_expected_max() > 1;
    if (node.kind != Kind::list || !many || node.list.empty()) {
      refuse(node.where, entry.key +
                             (many ? ": expected a value or a list of values, but this is "
                                   : ": expected a value, but this is ") +
                             describe(node));
    }
    std::vector<std::string> values;
    for (const core::YamlPtr& item : node.list) {
      if (item->kind != Kind::scalar) {
        refuse(item->where, entry.key + ": expected a value, but this is " + describe(*item));
      }
      values.push_back(item->scalar);
    }
    return values;
  }

  CLI::App& app_;
};

}  // namespace

void add_config_option(CLI::App& app) {
  app.set_config("--config", "",
                 "YAML file of options by their names (threads: 8); the command line goes first")
      ->type_name("FILE");
  app.config_formatter(std::make_shared<YamlConfig>(app));
  app.get_help_ptr()->configurable(false);
}

}  // namespace hyades::cli
