// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "xml.hpp"

#include <duet/core/errors.hpp>
#include <duet/core/text/csv.hpp>
#include <duet/core/text/file_error.hpp>

#if __has_include(<expat.h>) && !defined(DUET_WITHOUT_EXPAT)
#define DUET_IO_HAS_EXPAT
#include <expat.h>
#endif

#include <cstddef>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace duet::detail {
#ifdef DUET_IO_HAS_EXPAT

namespace {

/// Parser of one file.
class xml_parser {
public:
  static constexpr std::size_t max_depth = 100;

  xml_parser(const std::string& path, std::size_t max_megabytes, xml_text text)
      : path_(path), max_megabytes_(max_megabytes),
        parser_(XML_ParserCreate(nullptr)) { // the file defines its encoding
    if (parser_ == nullptr) {
      raise(std::bad_alloc());
    }
    XML_SetUserData(parser_, this);
    XML_SetElementHandler(parser_, open_element, close_element);
    XML_SetStartDoctypeDeclHandler(parser_, refuse_document_type);
    if (text == xml_text::kept) {
      XML_SetCharacterDataHandler(parser_, add_text);
    }
  }
  xml_parser(const xml_parser&) = delete;
  xml_parser& operator=(const xml_parser&) = delete;
  ~xml_parser() { XML_ParserFree(parser_); }

  /// \throws as `read_xml`
  [[nodiscard]] xml_element root() {
    const std::string text = whole_content(path_, max_megabytes_);
    const bool is_good =
        XML_Parse(parser_, text.data(), int(text.size()), XML_TRUE) == XML_STATUS_OK;
    if (is_out_of_memory_) {
      raise(std::bad_alloc());
    }
    if (!is_good) {
      const std::string reason =
          reason_.empty() ? XML_ErrorString(XML_GetErrorCode(parser_)) : reason_;
      raise(file_error(path_, line(), reason + location()));
    }
    return std::move(document_.children.front());
  }

private:
  [[nodiscard]] std::size_t line() const { return XML_GetCurrentLineNumber(parser_); }

  /// The element that the parser is in, for messages.
  [[nodiscard]] std::string location() const {
    return open_.size() < 2
               ? ""
               : ", in <" + open_.back()->name + "> of line " + std::to_string(open_.back()->line);
  }

  /// Calls a function from C and stops the parser if it throws.
  template <class Body>
  void guarded(const Body& body) {
    catching<void>(body, [&] {
      is_out_of_memory_ = true; // nothing else is thrown in callbacks
      XML_StopParser(parser_, XML_FALSE);
    });
  }
  void stop(const char* reason) {
    reason_ = reason;
    XML_StopParser(parser_, XML_FALSE);
  }

  static void XMLCALL open_element(void* data, const XML_Char* name, const XML_Char** attributes) {
    auto& self = *static_cast<xml_parser*>(data);
    self.guarded([&] {
      if (self.open_.size() > max_depth) {
        return self.stop("elements are nested more than 100 deep");
      }
      // The parent is open, so the elements before it in its own parent keep their addresses.
      xml_element& element = self.open_.back()->children.emplace_back();
      self.open_.push_back(&element);
      element.name = name;
      element.line = self.line();
      for (; *attributes != nullptr; attributes += 2) {
        element.attributes.emplace_back(attributes[0], attributes[1]);
      }
    });
  }
  static void XMLCALL close_element(void* data, const XML_Char*) {
    static_cast<xml_parser*>(data)->open_.pop_back();
  }
  static void XMLCALL add_text(void* data, const XML_Char* text, int size) {
    auto& self = *static_cast<xml_parser*>(data);
    self.guarded([&] { self.open_.back()->text.append(text, std::size_t(size)); });
  }
  static void XMLCALL refuse_document_type(void* data, const XML_Char*, const XML_Char*,
                                           const XML_Char*, int) {
    auto& self = *static_cast<xml_parser*>(data);
    self.guarded([&] { self.stop("document types, <!DOCTYPE, are not supported"); });
  }

  std::string path_;
  std::size_t max_megabytes_;
  XML_Parser parser_;
  xml_element document_; ///< document that contains the root
  std::vector<xml_element*> open_{&document_};
  std::string reason_;
  bool is_out_of_memory_ = false;
};

} // namespace

DUET_ABI_BEGIN

xml_element read_xml(const std::string& path, std::size_t max_megabytes, xml_text text) {
  return xml_parser(path, max_megabytes, text).root();
}

DUET_ABI_END

#else
DUET_ABI_BEGIN

xml_element read_xml(const std::string& path, std::size_t, xml_text) {
  raise(file_error(path, "is XML, which cannot be read: the library was built without expat"));
}

DUET_ABI_END
#endif
} // namespace duet::detail
