#include "SkyloopTruth.h"

#include "Common/UdpSocketBuilder.h"
#include "Components/PrimitiveComponent.h"
#include "Engine/World.h"
#include "GameFramework/Actor.h"
#include "SkyloopAxes.h"
#include "SocketSubsystem.h"
#include "Sockets.h"

USkyloopTruth::USkyloopTruth() {
    PrimaryComponentTick.bCanEverTick = true;
    PrimaryComponentTick.TickGroup = TG_PostPhysics;  // the step is done
}

void USkyloopTruth::BeginPlay() {
    Super::BeginPlay();
    ISocketSubsystem* Sockets = ISocketSubsystem::Get(PLATFORM_SOCKETSUBSYSTEM);
    Address = Sockets->CreateInternetAddr();
    bool bValid = false;
    Address->SetIp(*Host, bValid);
    Address->SetPort(Port);
    if (bValid) Socket = FUdpSocketBuilder(TEXT("skyloop")).AsNonBlocking().Build();
}

void USkyloopTruth::EndPlay(const EEndPlayReason::Type Reason) {
    Send(TEXT("{\"type\":\"bye\"}\n"));
    if (Socket) ISocketSubsystem::Get(PLATFORM_SOCKETSUBSYSTEM)->DestroySocket(Socket);
    Socket = nullptr;
    Super::EndPlay(Reason);
}

void USkyloopTruth::TickComponent(float Delta, ELevelTick Type, FActorComponentTickFunction* Function) {
    Super::TickComponent(Delta, Type, Function);
    // Game time: it stands while the game is paused, and runs slow in slow motion. Never the wall clock.
    const double Time = GetWorld()->GetTimeSeconds();
    if (OriginSentAt < 0 || Time - OriginSentAt >= 1) {
        Send(FString::Printf(TEXT("{\"type\":\"origin\",\"lla\":[%.9f,%.9f,%.4f],\"h_ref\":\"msl\"}\n"), OriginLatitude,
                             OriginLongitude, OriginHeight));
        OriginSentAt = Time;
    }
    // A shifted world origin is added back, else the vehicle would jump.
    const FVector Location = GetOwner()->GetActorLocation() + FVector(GetWorld()->OriginLocation);
    const UPrimitiveComponent* Body = Cast<UPrimitiveComponent>(GetOwner()->GetRootComponent());
    FVector Speed = FVector::ZeroVector;
    if (Body && Body->IsSimulatingPhysics())
        Speed = Body->GetPhysicsLinearVelocity();
    else if (LastTime >= 0 && Time > LastTime)
        Speed = (Location - LastLocation) / (Time - LastTime);
    LastLocation = Location;
    LastTime = Time;
    const auto P = SkyloopAxes::ToNed(Location.X, Location.Y, Location.Z, bXIsNorth);
    const auto V = SkyloopAxes::ToNed(Speed.X, Speed.Y, Speed.Z, bXIsNorth);
    const FQuat Turn = GetOwner()->GetActorQuat();
    const auto Q = SkyloopAxes::ToBodyToNed(Turn.X, Turn.Y, Turn.Z, Turn.W, bXIsNorth);
    Send(FString::Printf(TEXT("{\"type\":\"truth\",\"v\":1,\"id\":\"%s\",\"t\":%.6f,\"ned\":[%.4f,%.4f,%.4f],"
                              "\"vel_ned\":[%.4f,%.4f,%.4f],\"q\":[%.7f,%.7f,%.7f,%.7f]}\n"),
                         *Vehicle, Time, P[0], P[1], P[2], V[0], V[1], V[2], Q[0], Q[1], Q[2], Q[3]));
}

void USkyloopTruth::Send(const FString& Line) {
    if (!Socket) return;
    const FTCHARToUTF8 Bytes(*Line);
    int32 Sent = 0;
    Socket->SendTo(reinterpret_cast<const uint8*>(Bytes.Get()), Bytes.Length(), Sent, *Address);
}
