// An actor component that tells skyloop where its actor is: JSON lines by UDP. Copy the three files into your game
// module's folder, add "Sockets" and "Networking" to its Build.cs, and add the component to the vehicle.
#pragma once

#include "Components/ActorComponent.h"
#include "CoreMinimal.h"

#include "SkyloopTruth.generated.h"

class FSocket;

UCLASS(ClassGroup = (Custom), meta = (BlueprintSpawnableComponent))
class USkyloopTruth : public UActorComponent {
    GENERATED_BODY()

public:
    USkyloopTruth();

    // Where skyloop listens: source = "udp-json:29990".
    UPROPERTY(EditAnywhere) FString Host = TEXT("127.0.0.1");
    UPROPERTY(EditAnywhere) int32 Port = 29990;
    // The vehicle's name in the scenario.
    UPROPERTY(EditAnywhere) FString Vehicle = TEXT("0");
    // Where Unreal's origin lies: degrees, degrees, metres above the sea.
    UPROPERTY(EditAnywhere) double OriginLatitude = 47.3977;
    UPROPERTY(EditAnywhere) double OriginLongitude = 8.5456;
    UPROPERTY(EditAnywhere) double OriginHeight = 488;
    // AirSim's axes; else X points east and Y south.
    UPROPERTY(EditAnywhere) bool bXIsNorth = false;

    void BeginPlay() override;
    void EndPlay(const EEndPlayReason::Type Reason) override;
    void TickComponent(float Delta, ELevelTick Type, FActorComponentTickFunction* Function) override;

private:
    void Send(const FString& Line);

    FSocket* Socket = nullptr;
    TSharedPtr<class FInternetAddr> Address;
    FVector LastLocation = FVector::ZeroVector;
    double LastTime = -1;
    double OriginSentAt = -1;
};
