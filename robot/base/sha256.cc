#include "robot/base/sha256.h"

#include <openssl/evp.h>

#include <array>
#include <bit>

#include "robot/base/error.h"

namespace merlin {
namespace {

// Numbers are hashed as they lie in memory. A big-endian machine would have to reverse the bytes of each.
static_assert(std::endian::native == std::endian::little);

void Require(bool done) {
  if (!done) throw MachineError("OpenSSL cannot compute SHA-256");
}

}  // namespace

struct Sha256::Context {
  Context() : evp(EVP_MD_CTX_new()) { Require(evp != nullptr); }
  ~Context() { EVP_MD_CTX_free(evp); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  EVP_MD_CTX* evp;
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
  Require(EVP_DigestInit_ex(context_->evp, EVP_sha256(), nullptr) == 1);
}
Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;

void Sha256::Add(std::string_view bytes) { Require(EVP_DigestUpdate(context_->evp, bytes.data(), bytes.size()) == 1); }

void Sha256::AddLittleEndian(std::span<const std::byte> bytes) {
  Require(EVP_DigestUpdate(context_->evp, bytes.data(), bytes.size()) == 1);
}

std::string Sha256::Hex() const {
  Context copy;  // a context cannot be used after its digest is finished
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  Require(EVP_MD_CTX_copy_ex(copy.evp, context_->evp) == 1 && EVP_DigestFinal_ex(copy.evp, digest.data(), &size) == 1);
  constexpr char kDigits[] = "0123456789abcdef";
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) {
    hex += kDigits[digest[i] >> 4];
    hex += kDigits[digest[i] & 15];
  }
  return hex;
}

}  // namespace merlin
